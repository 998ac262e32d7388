// The instance lists of a page, which kernels fill.
layout(set = 0, binding = DRAW_INSTANCES, std430) buffer Instances { uint instances[]; };
layout(set = 0, binding = DRAW_COMMANDS, std430) buffer Commands { uint commands[]; };

uint countOf(int list) { return commands[list * DRAW_WORDS + 1]; }

// The entry's place in the list.
uint append(uint list, uint entry) {
  uint place = atomicAdd(commands[list * DRAW_WORDS + 1], 1u);
  instances[list * constants.agents + place] = entry;
  return place;
}
