#include "crowd/stage.h"
#include "embedded/navigate_comp_storage.h"
#include "embedded/navigate_comp_texel.h"
#include "embedded/navigate_forage_comp_storage.h"
#include "embedded/navigate_forage_comp_texel.h"
#include "embedded/navigate_forage_listed_comp_storage.h"
#include "embedded/navigate_forage_listed_comp_texel.h"
#include "embedded/navigate_listed_comp_storage.h"
#include "embedded/navigate_listed_comp_texel.h"
#include "embedded/navigate_ways_comp_storage.h"
#include "embedded/navigate_ways_comp_texel.h"
#include "embedded/navigate_ways_listed_comp_storage.h"
#include "embedded/navigate_ways_listed_comp_texel.h"
#include "shared/bindings.h"

namespace skitter::crowd {

Stage navigateStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage{StageId::navigate,
              {embedded::navigate_comp_texel(), embedded::navigate_comp_storage()},
              {{BINDING_PARAMETERS, uniform},
               {BINDING_GOAL, load4},
               {BINDING_GOAL_OUT, store},
               {BINDING_STEER_OUT, store},
               {BINDING_BODY, load4},
               {BINDING_GAIT, load4}},
              Stage::Over::everyone};
  stage.levelCode = {embedded::navigate_listed_comp_texel(), embedded::navigate_listed_comp_storage()};
  return stage;
}

Stage wayNavigateStage() {
  Stage stage = navigateStage();
  stage.code = {embedded::navigate_ways_comp_texel(), embedded::navigate_ways_comp_storage()};
  stage.levelCode = {embedded::navigate_ways_listed_comp_texel(),
                     embedded::navigate_ways_listed_comp_storage()};
  stage.bindings.push_back({shared::BINDING_WAY, gpu::BindingKind::load4});
  return stage;
}

Stage forageNavigateStage() {
  using namespace shared;
  using enum gpu::BindingKind;
  Stage stage = navigateStage();
  stage.code = {embedded::navigate_forage_comp_texel(), embedded::navigate_forage_comp_storage()};
  stage.levelCode = {embedded::navigate_forage_listed_comp_texel(),
                     embedded::navigate_forage_listed_comp_storage()};
  for (const gpu::BindingDecl& more : {gpu::BindingDecl{BINDING_FORAGER, load4},
                                       {BINDING_FORAGER_OUT, store},
                                       {BINDING_FORAGE_GROUND, store},
                                       {BINDING_TRAIL, store}})
    stage.bindings.push_back(more);
  return stage;
}

}  // namespace skitter::crowd
