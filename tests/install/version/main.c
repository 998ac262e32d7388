/* The same in C. */
#include <skitter.h>
#include <stdio.h>

int main(void) {
  skitter_scene* scene = NULL;
  if (skitter_scene_load("no such scene.json", &scene) != SKITTER_ERROR_INPUT) return 1;
  printf("%s: %s\n", skitter_version(), skitter_last_error());
  return 0;
}
