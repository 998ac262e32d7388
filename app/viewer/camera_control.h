#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "skitter/heightfield.h"
#include "skitter/renderer.h"

namespace skitter::app {

// The camera of a window: the scene's until the user takes hold of it, then an eye that turns about a pivot.
class CameraControl {
 public:
  // Once a frame, before anything else. `scene` is where the scene's camera is now. The pivot goes along with
  // the scene's target until the user pans or flies, and glides to the agent that is followed.
  struct Followed {
    glm::vec3 at;
    float near;  // the eye comes at least so close when it begins to follow, metres
  };
  void advance(const View& scene, const std::optional<Followed>& followed, float seconds);

  // The eye goes round the pivot by these angles to its left and upwards, radians.
  void orbit(float left, float up);
  // The picture's content moves by these shares of the picture's height, to the right and up.
  void pan(float right, float up);
  // One notch of a wheel is a tenth of the distance.
  void zoom(float notches);
  // `direction`: right, up and forward as the camera looks, 0 or 1 long. A second goes as far as the pivot
  // is, but at least 2 m.
  void fly(const glm::vec3& direction, float seconds);
  // Places the pivot where the line of sight meets the ground, if it does, so that what is seen in the middle
  // stays there.
  void aim(const Heightfield& ground);
  // The scene's camera again.
  void letGo() { hold_ = Hold::scene; }

  // What the user moved is never below the ground.
  View view(const Heightfield& ground) const;

 private:
  enum class Hold { scene, target, free };
  glm::vec3 forward() const;
  glm::vec3 right() const;
  void grasp(Hold least);

  Hold hold_ = Hold::scene;
  View scene_;
  glm::vec3 pivot_{0};
  float heading_ = 0, pitch_ = 0;            // of the line of sight, radians; pitch is positive upwards
  float distance_ = 1, wantedDistance_ = 1;  // from the eye to the pivot, metres
  bool following_ = false;
};

// Where a ray from `eye` along the unit vector `forward` meets the ground: metres, none where it does not
// within `most`.
std::optional<float> groundAlong(const Heightfield& ground, const glm::vec3& eye, const glm::vec3& forward,
                                 float most);

}  // namespace skitter::app
