#include "crowd/stage.h"
#include "embedded/avoid_comp_storage.h"
#include "embedded/avoid_comp_texel.h"
#include "embedded/avoid_listed_comp_storage.h"
#include "embedded/avoid_listed_comp_texel.h"
#include "embedded/avoid_walls_comp_storage.h"
#include "embedded/avoid_walls_comp_texel.h"
#include "embedded/avoid_walls_listed_comp_storage.h"
#include "embedded/avoid_walls_listed_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage avoidStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage{StageId::avoid,
              {embedded::avoid_comp_texel(), embedded::avoid_comp_storage()},
              {{BINDING_PARAMETERS, uniform},
               {BINDING_STEER, load4},
               {BINDING_AVOID_OUT, store},
               {BINDING_BODY, load4},
               {BINDING_CELL, load4},
               {BINDING_PLACE, load4},
               {BINDING_WALKER, load4},
               {BINDING_CROWDING, store}},
              Stage::Over::lookers};
  stage.seesCrowd = true;
  stage.levelCode = {embedded::avoid_listed_comp_texel(), embedded::avoid_listed_comp_storage()};
  return stage;
}

Stage wallAvoidStage() {
  Stage stage = avoidStage();
  stage.code = {embedded::avoid_walls_comp_texel(), embedded::avoid_walls_comp_storage()};
  stage.levelCode = {embedded::avoid_walls_listed_comp_texel(), embedded::avoid_walls_listed_comp_storage()};
  stage.bindings.push_back({shared::BINDING_WALL, gpu::BindingKind::load4});
  return stage;
}

}  // namespace skitter::crowd
