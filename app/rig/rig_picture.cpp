#include "app/rig/rig_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "app/rig/canvas.h"
#include "assets/materials/worn_colours.h"
#include "skitter/image.h"

namespace skitter::app {
namespace {

constexpr glm::vec3 background{0.80f, 0.82f, 0.85f}, groundColour{0.45f, 0.47f, 0.50f},
    ahead{0.05f, 0.05f, 0.05f};
constexpr std::array groupColours = {glm::vec3(0.90f, 0.18f, 0.02f), glm::vec3(0.02f, 0.16f, 0.80f),
                                     glm::vec3(0.05f, 0.50f, 0.08f), glm::vec3(0.60f, 0.05f, 0.60f),
                                     glm::vec3(0.05f, 0.50f, 0.55f), glm::vec3(0.65f, 0.45f, 0.02f)};
constexpr int coneSteps = 28;
constexpr float pi = 3.14159265f;

// A view from far away: `turn` about +Y from the creature's front, `lift` above its horizon.
class RigView {
 public:
  RigView(Canvas& canvas, const Rig& rig, const BaseColours& textures, glm::vec2 size, float turn, float lift)
      : canvas_(canvas), rig_(rig), textures_(textures), size_(size) {
    const glm::vec3 toViewer(std::cos(lift) * std::sin(turn), std::sin(lift),
                             std::cos(lift) * std::cos(turn));
    // From straight above, forward is up in the picture.
    const glm::vec3 up = lift > 1.5f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    right_ = glm::normalize(glm::cross(up, toViewer));
    up_ = glm::cross(toViewer, right_);
    toViewer_ = toViewer;
    fit();
  }

  void draw() {
    drawGround();
    drawSkin();
    for (const Leg& leg : rig_.legs) drawLeg(leg);
  }

 private:
  glm::vec2 onPicture(const glm::vec3& p) const { return {glm::dot(p, right_), -glm::dot(p, up_)}; }
  glm::vec3 project(const glm::vec3& p) const {
    return {(onPicture(p) - centre_) * scale_ + 0.5f * size_, glm::dot(p, toViewer_)};
  }

  void fit() {
    glm::vec2 least(1e9f), most(-1e9f);
    const auto include = [&](const glm::vec3& p) {
      least = glm::min(least, onPicture(p));
      most = glm::max(most, onPicture(p));
    };
    for (const SkinVertex& vertex : rig_.vertices) include(vertex.position);
    for (const Leg& leg : rig_.legs) {
      include(leg.home);
      for (const Bone& bone : leg.bones) include(bone.start + bone.direction * bone.length);
    }
    centre_ = 0.5f * (least + most);
    const glm::vec2 extent = glm::max(most - least, glm::vec2(1e-4f));
    scale_ = 0.88f * std::min(size_.x / extent.x, size_.y / extent.y);
  }

  void line(const glm::vec3& a, const glm::vec3& b, const glm::vec3& colour, float width, float opacity) {
    canvas_.line(project(a), project(b), colour, width, opacity);
  }

  // The homes' rectangle on the ground, and an arrow ahead.
  void drawGround() {
    glm::vec2 least(1e9f), most(-1e9f);
    for (const Leg& leg : rig_.legs) {
      least = glm::min(least, glm::vec2(leg.home.x, leg.home.z));
      most = glm::max(most, glm::vec2(leg.home.x, leg.home.z));
    }
    const std::array corners = {glm::vec3(least.x, 0, least.y), glm::vec3(most.x, 0, least.y),
                                glm::vec3(most.x, 0, most.y), glm::vec3(least.x, 0, most.y)};
    for (size_t i = 0; i < 4; ++i) line(corners[i], corners[(i + 1) % 4], groundColour, 1.5f, 1);
    const glm::vec3 head(0, 0, std::max(most.y, 0.3f * rig_.legLength));
    const float barb = 0.08f * rig_.legLength;
    line({0, 0, 0}, head, ahead, 2, 1);
    for (const float side : {-barb, barb}) line(head, head + glm::vec3(side, 0, -barb), ahead, 2, 1);
  }

  void drawSkin() {
    const glm::vec3 light = glm::normalize(0.5f * toViewer_ + glm::vec3(0, 1, 0) + 0.3f * right_);
    for (size_t t = 0; t + 2 < rig_.indices.size(); t += 3) {
      glm::vec3 corners[3], colours[3];
      glm::vec3 lit;  // of each corner
      for (int k = 0; k < 3; ++k) {
        const SkinVertex& vertex = rig_.vertices[rig_.indices[t + static_cast<size_t>(k)]];
        corners[k] = project(vertex.position);
        colours[k] = vertex.colour;
        lit[k] = 0.45f + 0.55f * std::max(0.0f, glm::dot(vertex.normal, light));
      }
      const auto paint = [&](const glm::vec3& shares, const glm::vec3& texture) {
        const glm::vec3 own = shares.x * colours[0] + shares.y * colours[1] + shares.z * colours[2];
        // Half way to white, so that chains show on dark creatures too.
        return glm::mix(own * texture, glm::vec3(0.6f), 0.55f) * glm::dot(shares, lit);
      };
      if (rig_.look)
        drawTextured(&rig_.indices[t], corners, paint);
      else
        canvas_.triangle(corners, [&](const glm::vec3& shares) { return paint(shares, glm::vec3(1)); });
    }
  }

  // Texel by texel, with the holes of masks.
  template <class PaintTexel>
  void drawTextured(const uint32_t* triangle, const glm::vec3 corners[3], const PaintTexel& paint) {
    std::array<MaterialVertex, 3> worn;
    for (size_t k = 0; k < 3; ++k) worn[k] = rig_.look.vertices[triangle[k]];
    const glm::vec2 a(corners[1] - corners[0]), b(corners[2] - corners[0]);
    const size_t level = textures_.levelOf(worn, 0.5f * std::fabs(a.x * b.y - a.y * b.x));
    const float cutoff = rig_.look.materials->list[worn[0].material].alphaCutoff;
    canvas_.triangle(corners, [&](const glm::vec3& shares) -> std::optional<glm::vec3> {
      MaterialVertex here = worn[0];
      for (int set = 0; set < 2; ++set)
        here.uv[set] = shares.x * worn[0].uv[set] + shares.y * worn[1].uv[set] + shares.z * worn[2].uv[set];
      const glm::vec4 texture = textures_.at(here, level);
      const float opacity = glm::dot(shares, {worn[0].opacity, worn[1].opacity, worn[2].opacity});
      if (opacity * texture.a < cutoff) return {};
      return paint(shares, glm::vec3(texture));
    });
  }

  void drawLeg(const Leg& leg) {
    const glm::vec3 colour = groupColours[static_cast<size_t>(leg.group) % groupColours.size()];
    for (const Bone& bone : leg.bones) drawCone(bone, colour);
    glm::vec3 tip = leg.root();
    for (const Bone& bone : leg.bones) {
      tip = bone.start + bone.direction * bone.length;
      line(bone.start, tip, colour, 3, 1);
      canvas_.disc(project(bone.start), 3.5f, colour);
    }
    canvas_.disc(project(tip), 3.5f, colour);
    const float arm = 0.04f * rig_.legLength;
    line(leg.home - glm::vec3(arm, 0, 0), leg.home + glm::vec3(arm, 0, 0), colour, 2, 1);
    line(leg.home - glm::vec3(0, 0, arm), leg.home + glm::vec3(0, 0, arm), colour, 2, 1);
  }

  // The bone may end anywhere within the circle, seen from its joint.
  void drawCone(const Bone& bone, const glm::vec3& colour) {
    if (bone.coneHalfAngle >= pi - 1e-3f) return;
    const glm::vec3 d = bone.direction;
    const glm::vec3 u =
        glm::normalize(glm::cross(d, std::fabs(d.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    const glm::vec3 v = glm::cross(d, u);
    const float slant = 0.4f * bone.length;
    const auto at = [&](int step) {
      const float angle = 2 * pi * static_cast<float>(step) / coneSteps;
      return bone.start +
             slant * (std::cos(bone.coneHalfAngle) * d +
                      std::sin(bone.coneHalfAngle) * (std::cos(angle) * u + std::sin(angle) * v));
    };
    for (int step = 0; step < coneSteps; ++step) {
      line(at(step), at(step + 1), colour, 1, 0.6f);
      if (step % (coneSteps / 4) == 0) line(bone.start, at(step), colour, 1, 0.4f);
    }
  }

  Canvas& canvas_;
  const Rig& rig_;
  const BaseColours& textures_;  // of its look
  glm::vec2 size_, centre_{0};
  glm::vec3 right_{1, 0, 0}, up_{0, 1, 0}, toViewer_{0, 0, 1};
  float scale_ = 1;
};

}  // namespace

void drawRig(const Rig& rig, Size size, const std::filesystem::path& file) {
  Canvas canvas(size.width, size.height, background);
  const BaseColours textures(rig.look);
  const uint32_t width = size.width / 2, height = size.height / 2;
  // From ahead and aside, from the left, from the front, from above.
  constexpr std::array<std::array<float, 2>, 4> views = {{{0.7f, 0.45f}, {pi / 2, 0}, {0, 0}, {0, pi / 2}}};
  for (uint32_t i = 0; i < views.size() && width > 0 && height > 0; ++i) {
    canvas.confine(i % 2 * width, i / 2 * height, width, height);
    RigView(canvas, rig, textures, {width, height}, views[i][0], views[i][1]).draw();
  }
  writePng(file, size.width, size.height, canvas.rgba());
}

}  // namespace skitter::app
