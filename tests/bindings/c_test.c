/* The C functions, each of them, called from C99: c_test NAME runs one test. */
#include <math.h>
#include <skitter.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static int failures = 0;

static void fail(int line, const char* what) {
  printf("c_test.c:%d: %s\n  last error: %s\n", line, what, skitter_last_error());
  ++failures;
}

#define CHECK(condition) ((condition) ? (void)0 : fail(__LINE__, #condition))
#define OK(call) CHECK((call) == SKITTER_OK)
/* What cannot be done without. */
#define NEED(call)              \
  do {                          \
    if ((call) != SKITTER_OK) { \
      fail(__LINE__, #call);    \
      exit(1);                  \
    }                           \
  } while (0)
/* The call is refused as wrong input, and the message says why. */
#define REFUSED(call, why)                              \
  do {                                                  \
    if ((call) != SKITTER_ERROR_INPUT)                  \
      fail(__LINE__, #call " is accepted");             \
    else if (strstr(skitter_last_error(), why) == NULL) \
      fail(__LINE__, #call " does not say: " why);      \
  } while (0)

static const float dt = 1.0f / 60;

static const char* const twoHerds =
    "{\"terrain\": {\"kind\": \"noise\", \"columns\": 65, \"rows\": 65},"
    " \"herds\": [{\"agents\": 20}, {\"agents\": 3, \"controller\": \"loop\"}]}";

/* Four who stand and look along +z, in the middle of ground that is flat. */
static const char* const standing =
    "{\"terrain\": {\"columns\": 65, \"rows\": 65, \"amplitude\": 0},"
    " \"herds\": [{\"agents\": 4, \"reserve\": 2, \"spawn\": {\"kind\": \"grid\"}, \"goal\": {\"kind\": "
    "\"none\"}}]}";

static skitter_device* openDevice(void) {
  skitter_device* device = NULL;
  NEED(skitter_device_create(NULL, &device));
  return device;
}

static skitter_crowd* makeCrowdOf(const char* json, skitter_device* device,
                                  const skitter_crowd_options* options) {
  skitter_scene* scene = NULL;
  skitter_crowd* crowd = NULL;
  NEED(skitter_scene_parse(json, NULL, &scene));
  NEED(skitter_crowd_create(device, scene, options, &crowd));
  OK(skitter_scene_destroy(scene));
  return crowd;
}

static skitter_crowd* makeCrowd(skitter_device* device, const skitter_crowd_options* options) {
  return makeCrowdOf(twoHerds, device, options);
}

/* Reading and drawing nothing. */
static void testNothingRead(void) {
  static const float record[16] = {0};
  const double place[3] = {0, 0, 0};
  const skitter_body none = {{0}, {0}, {0}, {0}, 0, 0};
  const skitter_record_buffer empty = {0};
  const skitter_footfall_buffer noFootfalls = {0};
  skitter_view view = {{0, 1, 0}, {0, 0, 0}, 0};
  skitter_terrain terrain;
  skitter_record_buffer buffer;
  skitter_footfall_buffer footfallBuffer;
  skitter_goal_buffer goalBuffer;
  skitter_body body;
  skitter_step step;
  skitter_foot foot;
  skitter_tip tip;
  skitter_bone bone;
  skitter_footfall footfall;
  skitter_picked picked;
  skitter_readback* readback = NULL;
  skitter_palettes* palettes = NULL;
  skitter_skin_mesh* mesh = NULL;
  skitter_renderer* renderer = NULL;
  VkImage image;
  const char* note;
  const float* records;
  float numbers[16];
  double least[3], most[3];
  uint8_t pixels[4];
  uint64_t m;
  uint32_t n;
  size_t s;
  int is;

  REFUSED(skitter_crowd_terrain(NULL, &terrain), "crowd is NULL");
  REFUSED(skitter_crowd_heights(NULL, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_ground(NULL, 0, 0, numbers, NULL), "crowd is NULL");

  REFUSED(skitter_crowd_buffers(NULL, 0, SKITTER_RECORD_BODY, &buffer, 1, &s), "crowd is NULL");
  REFUSED(skitter_record_at(NULL, 0, 0, &n), "buffer is NULL");
  REFUSED(skitter_record_at(&empty, 0, 0, &n), "agent is 0, expected one of the page's 0");
  REFUSED(skitter_crowd_footfall_buffers(NULL, 0, &footfallBuffer, 1, &s), "crowd is NULL");
  REFUSED(skitter_crowd_goal_buffers(NULL, 0, &goalBuffer, 1, &s), "crowd is NULL");
  REFUSED(skitter_crowd_records(NULL, 0, SKITTER_RECORD_BODY, numbers, 1, &s), "crowd is NULL");
  REFUSED(skitter_decode_body(NULL, NULL, &body), "record is NULL");
  REFUSED(skitter_decode_body(record, NULL, NULL), "body is NULL");
  REFUSED(skitter_decode_step(NULL, record, NULL, &step), "record is NULL");
  REFUSED(skitter_decode_step(record, NULL, NULL, &step), "body is NULL");
  REFUSED(skitter_decode_step(record, record, NULL, NULL), "step is NULL");
  REFUSED(skitter_decode_foot(NULL, &none, &foot), "record is NULL");
  REFUSED(skitter_decode_foot(record, NULL, &foot), "body is NULL");
  REFUSED(skitter_decode_foot(record, &none, NULL), "foot is NULL");
  REFUSED(skitter_decode_tip(NULL, &none, &tip), "record is NULL");
  REFUSED(skitter_decode_tip(record, &none, NULL), "tip is NULL");
  REFUSED(skitter_decode_bone(NULL, 8, 0, &bone), "pose is NULL");
  REFUSED(skitter_decode_bone(NULL, 0, 0, &bone), "pose has 0 floats");
  REFUSED(skitter_decode_bone(record, 8, 0, NULL), "bone is NULL");
  REFUSED(skitter_decode_joint(NULL, 12, 0, numbers), "pose is NULL");
  REFUSED(skitter_decode_joint(record, 12, 0, NULL), "rows is NULL");
  REFUSED(skitter_decode_footfall(NULL, &noFootfalls, &footfall, &is), "event is NULL");
  REFUSED(skitter_decode_footfall(record, NULL, &footfall, &is), "buffer is NULL");
  REFUSED(skitter_decode_footfall(record, &noFootfalls, NULL, &is), "footfall is NULL");
  REFUSED(skitter_decode_footfall(record, &noFootfalls, &footfall, NULL), "of_herd is NULL");

  REFUSED(skitter_readback_create(NULL, NULL, &readback), "crowd is NULL");
  REFUSED(skitter_readback_record(NULL, NULL), "readback is NULL");
  REFUSED(skitter_readback_step(NULL, 1, dt), "readback is NULL");
  REFUSED(skitter_readback_skipped(NULL, &m), "readback is NULL");
  REFUSED(skitter_readback_take(NULL, &m, &is), "readback is NULL");
  REFUSED(skitter_readback_places(NULL, 0, &n), "readback is NULL");
  REFUSED(skitter_readback_positions(NULL, 0, NULL, least, 1), "readback is NULL");
  REFUSED(skitter_readback_bodies(NULL, 0, &records), "readback is NULL");
  REFUSED(skitter_readback_bounds(NULL, 0, NULL, least, most, &is), "readback is NULL");
  REFUSED(skitter_readback_pick(NULL, place, place, 1, &picked, &is), "readback is NULL");
  REFUSED(skitter_readback_nearest(NULL, place, &picked, &is), "readback is NULL");

  REFUSED(skitter_crowd_palette_entries(NULL, 0, &n), "crowd is NULL");
  REFUSED(skitter_palettes_create(NULL, 0, NULL, 0, NULL, &palettes), "crowd is NULL");
  REFUSED(skitter_palettes_record(NULL, NULL, NULL, 0), "palettes is NULL");
  REFUSED(skitter_skin_mesh_create(NULL, 0, NULL, &mesh), "crowd is NULL");
  REFUSED(skitter_skin_mesh_vertices(NULL, NULL, 0, &s), "mesh is NULL");
  REFUSED(skitter_skin_mesh_indices(NULL, NULL, 0, &s), "mesh is NULL");
  REFUSED(skitter_skin_mesh_levels(NULL, NULL, 0, &s), "mesh is NULL");
  REFUSED(skitter_skin_mesh_radius(NULL, numbers), "mesh is NULL");

  REFUSED(skitter_scene_view(NULL, NULL, 0, &view), "scene is NULL");
  REFUSED(skitter_renderer_create(NULL, 1, 1, NULL, &renderer), "crowd is NULL");
  REFUSED(skitter_renderer_draw(NULL, &view), "renderer is NULL");
  REFUSED(skitter_renderer_record(NULL, NULL, &view, NULL, NULL), "renderer is NULL");
  REFUSED(skitter_renderer_image(NULL, &image), "renderer is NULL");
  REFUSED(skitter_renderer_pixels(NULL, pixels, sizeof pixels), "renderer is NULL");
  REFUSED(skitter_renderer_note(NULL, 0, &note), "renderer is NULL");

  OK(skitter_readback_destroy(NULL));
  OK(skitter_palettes_destroy(NULL));
  OK(skitter_skin_mesh_destroy(NULL));
  OK(skitter_renderer_destroy(NULL));
}

static void testErrors(void) {
  skitter_device* device = NULL;
  skitter_scene* scene = NULL;
  skitter_crowd* crowd = NULL;
  skitter_state* state = NULL;
  skitter_ik_batch* batch = NULL;
  skitter_spline_batch* splines = NULL;
  skitter_device_info info;
  skitter_fidelity fidelity;
  skitter_footfall footfall;
  skitter_adoption nothing;
  skitter_goal goal;
  skitter_place place;
  skitter_herd_id herd = {0, 0};
  skitter_picked picked;
  skitter_leg_state leg;
  const char* note;
  int is;
  uint32_t n;
  uint64_t m;
  size_t s;
  double places[3];
  float numbers[3];

  CHECK(strcmp(skitter_last_error(), "") == 0);
  CHECK(strcmp(skitter_version(), "0.1.0") == 0);

  REFUSED(skitter_device_list(&info, 1, NULL), "count is NULL");
  REFUSED(skitter_device_list(NULL, 1, &n), "infos is NULL");
  REFUSED(skitter_device_create(NULL, NULL), "device is NULL");
  CHECK(skitter_device_create("no such device", &device) == SKITTER_ERROR_DEVICE);
  CHECK(strstr(skitter_last_error(), "no such device") != NULL);
  CHECK(device == NULL);
  REFUSED(skitter_device_adopt(NULL, &device), "from is NULL");
  memset(&nothing, 0, sizeof nothing);
  REFUSED(skitter_device_adopt(&nothing, &device), "from->instance is NULL");
  REFUSED(skitter_device_adopt(&nothing, NULL), "device is NULL");

  REFUSED(skitter_scene_builtin(NULL), "scene is NULL");
  REFUSED(skitter_scene_load(NULL, &scene), "file is NULL");
  REFUSED(skitter_scene_load("/no/such.json", &scene), "/no/such.json");
  REFUSED(skitter_scene_parse(NULL, NULL, &scene), "json is NULL");
  REFUSED(skitter_scene_parse("{\"herd\": 1}", NULL, &scene), "herd is no known key");
  CHECK(scene == NULL);
  NEED(skitter_scene_builtin(&scene));
  REFUSED(skitter_scene_herds(NULL, &n), "scene is NULL");
  REFUSED(skitter_scene_herds(scene, NULL), "herds is NULL");
  REFUSED(skitter_scene_agents(scene, 1, &n), "herd 1: the scene has 1");
  REFUSED(skitter_scene_agents(scene, 0, NULL), "agents is NULL");
  REFUSED(skitter_scene_set_agents(scene, 7, 1), "herd 7");
  REFUSED(skitter_scene_set_agents(NULL, 0, 1), "scene is NULL");
  REFUSED(skitter_scene_set_seed(NULL, 1), "scene is NULL");

  REFUSED(skitter_crowd_create(NULL, scene, NULL, &crowd), "device is NULL");
  REFUSED(skitter_crowd_record(NULL, NULL, dt), "commands is NULL");
  REFUSED(skitter_crowd_step(NULL, 1, dt), "crowd is NULL");
  REFUSED(skitter_crowd_tick(NULL, &m), "crowd is NULL");
  REFUSED(skitter_crowd_herds(NULL, &n), "crowd is NULL");
  REFUSED(skitter_crowd_agent_count(NULL, &m), "crowd is NULL");
  REFUSED(skitter_crowd_herd_agents(NULL, 0, &n), "crowd is NULL");
  REFUSED(skitter_crowd_herd_legs(NULL, 0, &n), "crowd is NULL");
  REFUSED(skitter_crowd_herd_bones(NULL, 0, &n), "crowd is NULL");
  REFUSED(skitter_crowd_sizes(NULL, 0, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_positions(NULL, 0, places, 1), "crowd is NULL");
  REFUSED(skitter_crowd_headings(NULL, 0, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_joints(NULL, 0, places, 1), "crowd is NULL");
  REFUSED(skitter_crowd_state_hash(NULL, &m), "crowd is NULL");
  REFUSED(skitter_crowd_fidelity(NULL, 0, &fidelity), "crowd is NULL");
  REFUSED(skitter_crowd_footfalls(NULL, 0, &footfall, 1, &s), "crowd is NULL");
  REFUSED(skitter_crowd_herd_places(NULL, 0, &n), "crowd is NULL");
  REFUSED(skitter_crowd_edit_heights(NULL, 0, 0, 1, 1, numbers), "crowd is NULL");
  REFUSED(skitter_crowd_pick(NULL, places, places, 1, &picked, &is), "crowd is NULL");
  REFUSED(skitter_crowd_nearest(NULL, places, &picked, &is), "crowd is NULL");

  memset(&goal, 0, sizeof goal);
  memset(&place, 0, sizeof place);
  REFUSED(skitter_crowd_agent_id(NULL, 0, 0, &m), "crowd is NULL");
  REFUSED(skitter_crowd_agent_ids(NULL, 0, &m, 1), "crowd is NULL");
  REFUSED(skitter_crowd_has(NULL, SKITTER_NO_AGENT, &is), "crowd is NULL");
  REFUSED(skitter_crowd_steer(NULL, 0, &goal), "crowd is NULL");
  REFUSED(skitter_crowd_steer_each(NULL, 0, &goal, 1), "crowd is NULL");
  REFUSED(skitter_crowd_steer_agents(NULL, &m, &goal, 1), "crowd is NULL");
  REFUSED(skitter_crowd_set_speed(NULL, 0, 1), "crowd is NULL");
  REFUSED(skitter_crowd_set_speed_each(NULL, 0, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_set_speed_agents(NULL, &m, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_teleport(NULL, &m, &place, 1), "crowd is NULL");
  REFUSED(skitter_crowd_add(NULL, 0, &place, NULL, NULL), "crowd is NULL");
  REFUSED(skitter_crowd_remove(NULL, 0), "crowd is NULL");
  REFUSED(skitter_crowd_set_threat(NULL, 0, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_cannot_reach(NULL, 0, &n), "crowd is NULL");
  REFUSED(skitter_crowd_hurt(NULL, NULL, 0), "crowd is NULL");
  REFUSED(skitter_crowd_heal(NULL, 0), "crowd is NULL");
  REFUSED(skitter_crowd_leg_state(NULL, 0, 0, &leg), "crowd is NULL");
  REFUSED(skitter_crowd_add_herd(NULL, scene, 0, &herd), "crowd is NULL");
  REFUSED(skitter_crowd_remove_herd(NULL, herd), "crowd is NULL");
  REFUSED(skitter_crowd_herd_id(NULL, 0, &herd), "crowd is NULL");
  REFUSED(skitter_crowd_has_herd(NULL, herd, &is), "crowd is NULL");

  REFUSED(skitter_crowd_save(NULL, "never.state", NULL), "crowd is NULL");
  REFUSED(skitter_crowd_save_to_memory(NULL, NULL, NULL, 0, &s), "crowd is NULL");
  REFUSED(skitter_crowd_resume(NULL, NULL, NULL, &crowd), "device is NULL");
  REFUSED(skitter_state_load(NULL, &state), "file is NULL");
  REFUSED(skitter_state_load("/no/such.state", &state), "/no/such.state");
  REFUSED(skitter_state_load("/no/such.state", NULL), "state is NULL");
  REFUSED(skitter_state_parse(NULL, 1, &state), "bytes is NULL");
  REFUSED(skitter_state_parse("no state of a crowd at all", 26, &state), "is no state of a crowd");
  REFUSED(skitter_state_parse(NULL, 0, &state), "is no state of a crowd");
  CHECK(state == NULL);
  REFUSED(skitter_state_tick(NULL, &m), "state is NULL");
  REFUSED(skitter_state_dt(NULL, numbers), "state is NULL");
  REFUSED(skitter_state_note(NULL, &note), "state is NULL");

  REFUSED(skitter_state_scene(NULL, &scene), "state is NULL");

  testNothingRead();

  REFUSED(skitter_ik_batch_create(NULL, NULL, 1, 1, NULL, &batch), "device is NULL");
  REFUSED(skitter_ik_batch_set_targets(NULL, numbers, 1), "batch is NULL");
  REFUSED(skitter_ik_batch_solve(NULL), "batch is NULL");
  REFUSED(skitter_ik_batch_record(NULL, NULL), "batch is NULL");
  REFUSED(skitter_ik_batch_joints(NULL, numbers, 1), "batch is NULL");
  REFUSED(skitter_ik_batch_reports(NULL, NULL, 1), "batch is NULL");

  REFUSED(skitter_spline_batch_create(NULL, 1, NULL, &splines), "device is NULL");
  REFUSED(skitter_spline_batch_set_points(NULL, numbers, 1, NULL, 0), "batch is NULL");
  REFUSED(skitter_spline_batch_set_tangents(NULL, numbers, NULL, 1), "batch is NULL");
  REFUSED(skitter_spline_batch_set_clocks(NULL, NULL, 0), "batch is NULL");
  REFUSED(skitter_spline_batch_travel(NULL, 0), "batch is NULL");
  REFUSED(skitter_spline_batch_record(NULL, NULL, 0), "batch is NULL");
  REFUSED(skitter_spline_batch_motions(NULL, NULL, 0), "batch is NULL");
  REFUSED(skitter_spline_batch_lengths(NULL, numbers, 1), "batch is NULL");

  OK(skitter_scene_destroy(scene));
  OK(skitter_device_destroy(NULL));
  OK(skitter_scene_destroy(NULL));
  OK(skitter_crowd_destroy(NULL));
  OK(skitter_state_destroy(NULL));
  OK(skitter_ik_batch_destroy(NULL));
  OK(skitter_spline_batch_destroy(NULL));
}

static void testScene(void) {
  skitter_scene* scene = NULL;
  uint32_t herds = 0, agents = 0;
  FILE* file;

  NEED(skitter_scene_builtin(&scene));
  OK(skitter_scene_herds(scene, &herds));
  OK(skitter_scene_agents(scene, 0, &agents));
  CHECK(herds == 1 && agents == 1000);
  OK(skitter_scene_set_agents(scene, 0, 12));
  OK(skitter_scene_agents(scene, 0, &agents));
  CHECK(agents == 12);
  OK(skitter_scene_destroy(scene));

  file = fopen("c_test_scene.json", "w");
  if (file == NULL) exit(1);
  fputs(twoHerds, file);
  fclose(file);
  NEED(skitter_scene_load("c_test_scene.json", &scene));
  remove("c_test_scene.json");
  OK(skitter_scene_herds(scene, &herds));
  OK(skitter_scene_agents(scene, 1, &agents));
  CHECK(herds == 2 && agents == 3);
  OK(skitter_scene_destroy(scene));

  /* A file name in the text is looked for in the folder. */
  NEED(skitter_scene_parse("{\"terrain\": {\"kind\": \"file\", \"file\": \"hills.png\"}}", "/no/where",
                           &scene));
  {
    skitter_device* device = openDevice();
    skitter_crowd* crowd = NULL;
    REFUSED(skitter_crowd_create(device, scene, NULL, &crowd), "/no/where/hills.png");
    OK(skitter_device_destroy(device));
  }
  OK(skitter_scene_destroy(scene));
}

static void testDevices(void) {
  skitter_device_info infos[8];
  uint32_t count = 0, chosen = 0, i;
  OK(skitter_device_list(NULL, 0, &count));
  CHECK(count > 0);
  OK(skitter_device_list(infos, COUNT(infos), &count));
  for (i = 0; i < count && i < COUNT(infos); ++i) {
    CHECK(infos[i].name[0] != '\0' && infos[i].type[0] != '\0');
    CHECK(infos[i].chosen || infos[i].why_not[0] != '\0');
    if (infos[i].chosen) ++chosen;
  }
  CHECK(chosen == 1);
}

/* The horizontal distance from a to b. */
static double apart(const double* a, const double* b) { return hypot(b[0] - a[0], b[2] - a[2]); }

static void testCrowd(void) {
  skitter_device* device = openDevice();
  skitter_crowd_options options = {0};
  skitter_crowd* crowd;
  uint64_t tick = 1, agents = 0, hash = 0, again = 0;
  uint32_t herds = 0, inHerd = 0, legs = 0, bones = 0, touchdowns = 0, i;
  double before[20 * 3], after[20 * 3], walked = 0;
  float headings[20];
  double* joints;
  skitter_fidelity all, first, other;
  skitter_footfall footfalls[20 * 8];
  size_t count = 0, k;

  testDevices();
  options.footfalls = 1000;
  crowd = makeCrowd(device, &options);
  /* What was made on the device keeps it. */
  OK(skitter_device_destroy(device));

  OK(skitter_crowd_tick(crowd, &tick));
  OK(skitter_crowd_herds(crowd, &herds));
  OK(skitter_crowd_agent_count(crowd, &agents));
  OK(skitter_crowd_herd_agents(crowd, 1, &inHerd));
  OK(skitter_crowd_herd_legs(crowd, 0, &legs));
  OK(skitter_crowd_herd_bones(crowd, 0, &bones));
  CHECK(tick == 0 && herds == 2 && agents == 23 && inHerd == 3 && legs == 8 && bones == 4);
  REFUSED(skitter_crowd_herd_agents(crowd, 2, &inHerd), "herd 2: expected one of the crowd's 2 herds");
  REFUSED(skitter_crowd_footfalls(crowd, 2, NULL, 0, &count), "herd 2");
  REFUSED(skitter_crowd_tick(crowd, NULL), "tick is NULL");

  OK(skitter_crowd_positions(crowd, 0, before, 20));
  REFUSED(skitter_crowd_positions(crowd, 0, after, 19), "room for 19, expected 20");
  for (i = 0; i < 60; ++i) {
    OK(skitter_crowd_step(crowd, 1, dt));
    OK(skitter_crowd_footfalls(crowd, 0, NULL, 0, &count));
    OK(skitter_crowd_footfalls(crowd, 0, footfalls, COUNT(footfalls), &count));
    for (k = 0; k < count; ++k) {
      CHECK(footfalls[k].tick == i + 1u && footfalls[k].agent < 20 && footfalls[k].leg < 8);
      CHECK(footfalls[k].speed >= 0);
      ++touchdowns;
    }
  }
  CHECK(touchdowns > 100);
  OK(skitter_crowd_tick(crowd, &tick));
  CHECK(tick == 60);
  OK(skitter_crowd_positions(crowd, 0, after, 20));
  OK(skitter_crowd_headings(crowd, 0, headings, 20));
  for (i = 0; i < 20; ++i) {
    const double* a = before + 3 * i;
    const double* b = after + 3 * i;
    walked += apart(a, b);
    /* They walk to where they look. */
    CHECK((b[0] - a[0]) * sin(headings[i]) + (b[2] - a[2]) * cos(headings[i]) > 0.9 * apart(a, b));
  }
  CHECK(walked > 20 * 0.5 && walked < 20 * 1.2);

  joints = malloc(20 * 8 * 5 * 3 * sizeof *joints);
  if (joints == NULL) exit(1);
  REFUSED(skitter_crowd_joints(crowd, 0, joints, 20 * 8 * 5 - 1), "room for 799, expected 800");
  OK(skitter_crowd_joints(crowd, 0, joints, 20 * 8 * 5));
  for (i = 0; i < 20 * 8 * 5; ++i) {
    /* The spider's legs are a metre long. */
    CHECK(apart(joints + 3 * i, after + 3 * (i / 40)) < 1.3);
  }
  free(joints);

  OK(skitter_crowd_fidelity(crowd, SKITTER_ALL_HERDS, &all));
  OK(skitter_crowd_fidelity(crowd, 0, &first));
  OK(skitter_crowd_fidelity(crowd, 1, &other));
  REFUSED(skitter_crowd_fidelity(crowd, 2, &other), "herd 2");
  CHECK(first.agent_ticks == 20 * 60 && other.agent_ticks == 3 * 60 && all.agent_ticks == 23 * 60);
  CHECK(first.limit_violation >= 0 && first.stances > 0 && first.margin > 0);

  /* The same ticks, asked for at once, lead to the same state; others do not. */
  OK(skitter_crowd_state_hash(crowd, &hash));
  device = openDevice();
  {
    skitter_crowd* second = makeCrowd(device, NULL);
    OK(skitter_crowd_step(second, 59, dt));
    OK(skitter_crowd_state_hash(second, &again));
    CHECK(hash != again);
    OK(skitter_crowd_step(second, 1, dt));
    OK(skitter_crowd_state_hash(second, &again));
    CHECK(hash == again);
    REFUSED(skitter_crowd_step(second, 1, 2 * dt), "keeps its first dt");
    REFUSED(skitter_crowd_step(second, 1, -1), "dt");
    OK(skitter_crowd_step(second, 1, dt));
    OK(skitter_crowd_tick(second, &tick));
    CHECK(tick == 61);
    OK(skitter_crowd_footfalls(second, 0, footfalls, COUNT(footfalls), &count));
    CHECK(count == 0);
    OK(skitter_crowd_destroy(second));
  }
  options.no_poses = options.no_figures = 1;
  {
    skitter_crowd* bare = makeCrowd(device, &options);
    double place[3];
    OK(skitter_crowd_step(bare, 60, dt));
    OK(skitter_crowd_state_hash(bare, &again));
    CHECK(hash == again);
    OK(skitter_crowd_fidelity(bare, SKITTER_ALL_HERDS, &all));
    CHECK(all.agent_ticks == 0);
    REFUSED(skitter_crowd_joints(bare, 1, place, 3 * 8 * 5), "made with poses");
    OK(skitter_crowd_destroy(bare));
  }
  OK(skitter_device_destroy(device));
  OK(skitter_crowd_destroy(crowd));
}

/* The length of each bone is as the size of its agent's place says. */
static void testSizes(void) {
  static const char* const sized =
      "{\"terrain\": {\"columns\": 65, \"rows\": 65}, \"herds\": [{\"agents\": 20, \"sizes\": [2, 0.5]}]}";
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowdOf(sized, device, NULL);
  static double joints[20 * 8 * 5 * 3];
  float sizes[20];
  int i, k;
  REFUSED(skitter_crowd_sizes(crowd, 0, sizes, 19), "sizes has room for 19, expected 20");
  REFUSED(skitter_crowd_sizes(crowd, 1, sizes, 20), "herd 1");
  REFUSED(skitter_crowd_sizes(crowd, 0, NULL, 20), "sizes is NULL");
  OK(skitter_crowd_sizes(crowd, 0, sizes, 20));
  CHECK(sizes[0] == 2 && sizes[19] == 0.5f);
  OK(skitter_crowd_step(crowd, 30, dt));
  OK(skitter_crowd_joints(crowd, 0, joints, 20 * 8 * 5));
  for (i = 0; i < 20; ++i) {
    const double *first = joints + 3 * 8 * 5 * i, *large = joints;
    double length = 0, largest = 0;
    CHECK(i == 0 || sizes[i] <= sizes[i - 1]);
    for (k = 0; k < 3; ++k) {
      length += (first[3 + k] - first[k]) * (first[3 + k] - first[k]);
      largest += (large[3 + k] - large[k]) * (large[3 + k] - large[k]);
    }
    CHECK(fabs(sqrt(length) - sizes[i] / 2 * sqrt(largest)) < 1e-3);
  }
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

/* The ways that four agents go in so many ticks. */
static void waysOf(skitter_crowd* crowd, uint64_t ticks, double ways[4][2]) {
  double before[6 * 3], after[6 * 3];
  int i;
  OK(skitter_crowd_positions(crowd, 0, before, 6));
  OK(skitter_crowd_step(crowd, ticks, dt));
  OK(skitter_crowd_positions(crowd, 0, after, 6));
  for (i = 0; i < 4; ++i) {
    ways[i][0] = after[3 * i] - before[3 * i];
    ways[i][1] = after[3 * i + 2] - before[3 * i + 2];
  }
}

static void testSpeeds(skitter_crowd* crowd, const skitter_agent_id* ids) {
  const float speeds[6] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}, none = 0;
  double ways[4][2];
  int i;
  OK(skitter_crowd_set_speed(crowd, 0, 0.25f));
  OK(skitter_crowd_step(crowd, 60, dt));
  waysOf(crowd, 60, ways);
  for (i = 0; i < 4; ++i) CHECK(fabs(ways[i][1] - 0.25) < 0.1);
  REFUSED(skitter_crowd_set_speed(crowd, 0, -1), "the speed is -1 m/s, expected 0 to 1000");
  REFUSED(skitter_crowd_set_speed_each(crowd, 0, speeds, 4), "found 4 speeds, expected 6, one a place");
  REFUSED(skitter_crowd_set_speed_each(crowd, 0, NULL, 6), "speeds is NULL");
  OK(skitter_crowd_set_speed_each(crowd, 0, speeds, 6));
  OK(skitter_crowd_set_speed_agents(crowd, ids + 2, &none, 1));
  OK(skitter_crowd_step(crowd, 60, dt));
  waysOf(crowd, 60, ways);
  for (i = 0; i < 4; ++i) CHECK(fabs(ways[i][1] - (i == 2 ? 0 : 0.5)) < 0.1);
}

static skitter_leg_state legOf(const skitter_crowd* crowd, skitter_agent_id agent, uint32_t leg) {
  skitter_leg_state state = SKITTER_LEG_LAME;
  OK(skitter_crowd_leg_state(crowd, agent, leg, &state));
  return state;
}

static void testSearches(skitter_device* device) {
  skitter_crowd* crowd = makeCrowdOf(
      "{\"herds\": [{\"agents\": 2, \"hurt\": true, \"adapts\": true, "
      "\"goal\": {\"kind\": \"velocity\", \"velocity\": [0, 1]}}]}",
      device, NULL);
  skitter_agent_leg leg = {0};
  skitter_search searches[2];
  leg.leg = 3;
  leg.bone = SKITTER_STUMP;
  leg.state = SKITTER_LEG_LOST;
  OK(skitter_crowd_agent_id(crowd, 0, 1, &leg.agent));
  OK(skitter_crowd_hurt(crowd, &leg, 1));
  OK(skitter_crowd_step(crowd, 260, dt));
  REFUSED(skitter_crowd_searches(crowd, 0, NULL, 2), "searches is NULL");
  REFUSED(skitter_crowd_searches(crowd, 0, searches, 1), "searches has room for 1");
  OK(skitter_crowd_searches(crowd, 0, searches, 2));
  CHECK(searches[0].phase == SKITTER_SEARCH_AT_EASE && searches[0].trials == 0);
  CHECK(searches[1].phase != SKITTER_SEARCH_AT_EASE && searches[1].trials == 1 && searches[1].best > 0.5f);
  OK(skitter_crowd_destroy(crowd));
}

static void testLegs(void) {
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowdOf(
      "{\"terrain\": {\"columns\": 65, \"rows\": 65, \"amplitude\": 0},"
      " \"herds\": [{\"agents\": 4, \"hurt\": true}, {\"agents\": 1}]}",
      device, NULL);
  skitter_agent_leg legs[2] = {{0, 3, SKITTER_LEG_LOST, SKITTER_STUMP}, {0, 4, SKITTER_LEG_STUCK, 0}};
  skitter_agent_id ids[4], other;
  skitter_leg_state state;
  size_t count = 0;
  static float hurt[4 * 11 * 4], carried[4 * 4];
  skitter_agent_load loads[2] = {{0, {0.5f, {0, 0, 0}}}, {0, {2, {0, 0.5f, -1}}}};
  skitter_load load;
  OK(skitter_crowd_agent_ids(crowd, 0, ids, 4));
  OK(skitter_crowd_agent_id(crowd, 1, 0, &other));
  CHECK(legOf(crowd, ids[1], 3) == SKITTER_LEG_WHOLE);
  legs[0].agent = ids[1];
  legs[1].agent = ids[2];
  OK(skitter_crowd_hurt(crowd, legs, 2));
  OK(skitter_crowd_hurt(crowd, NULL, 0));
  CHECK(legOf(crowd, ids[1], 3) == SKITTER_LEG_LOST && legOf(crowd, ids[2], 4) == SKITTER_LEG_STUCK);
  CHECK(legOf(crowd, ids[0], 3) == SKITTER_LEG_WHOLE && legOf(crowd, ids[1], 4) == SKITTER_LEG_WHOLE);
  OK(skitter_crowd_step(crowd, 60, dt));
  OK(skitter_crowd_heal(crowd, ids[1]));
  CHECK(legOf(crowd, ids[1], 3) == SKITTER_LEG_WHOLE && legOf(crowd, ids[2], 4) == SKITTER_LEG_STUCK);
  OK(skitter_crowd_step(crowd, 1, dt));
  /* The mask of lost legs, and of stuck ones: docs/damage.md. */
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_HURT, hurt, COUNT(hurt), &count));
  CHECK(count == COUNT(hurt));
  CHECK(hurt[4 * 11] == 0 && hurt[2 * 4 * 11 + 1] == 16);

  /* Loads. */
  loads[0].agent = ids[0];
  loads[1].agent = ids[1];
  OK(skitter_crowd_carry(crowd, loads, 2));
  OK(skitter_crowd_carry(crowd, NULL, 0));
  OK(skitter_crowd_carried(crowd, ids[1], &load));
  CHECK(load.mass == 2 && load.offset[0] == 0 && load.offset[1] == 0.5f && load.offset[2] == -1);
  OK(skitter_crowd_carried(crowd, ids[2], &load));
  CHECK(load.mass == 0);
  OK(skitter_crowd_step(crowd, 1, dt));
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_CARRIED, carried, COUNT(carried), &count));
  CHECK(count == COUNT(carried) && carried[3] == 0.5f && carried[6] == -1 && carried[7] == 2);
  loads[0].load.mass = 1;
  loads[1].load.mass = 5;
  REFUSED(skitter_crowd_carry(crowd, loads, 2), "load.mass is 5");
  OK(skitter_crowd_carried(crowd, ids[0], &load));
  CHECK(load.mass == 0.5f);
  loads[0].agent = other;
  REFUSED(skitter_crowd_carry(crowd, loads, 1), "hurt is false");
  REFUSED(skitter_crowd_carry(crowd, NULL, 1), "loads is NULL");
  REFUSED(skitter_crowd_carried(crowd, ids[0], NULL), "load is NULL");
  REFUSED(skitter_crowd_carried(crowd, SKITTER_NO_AGENT, &load), "herd");

  /* Nothing is changed where something cannot be. */
  legs[0].state = SKITTER_LEG_LAME;
  legs[1].leg = 8;
  REFUSED(skitter_crowd_hurt(crowd, legs, 2), "leg is 8, expected less than 8");
  CHECK(legOf(crowd, ids[1], 3) == SKITTER_LEG_WHOLE);
  legs[0].state = SKITTER_LEG_LOST;
  legs[0].bone = 4;
  REFUSED(skitter_crowd_hurt(crowd, legs, 1), "bone is 4, expected less than 4");
  legs[0].bone = 2;
  legs[0].state = (skitter_leg_state)4;
  REFUSED(skitter_crowd_hurt(crowd, legs, 1), "state is 4, expected a skitter_leg_state");
  legs[0].state = SKITTER_LEG_LOST;
  legs[0].agent = other;
  REFUSED(skitter_crowd_hurt(crowd, legs, 1), "hurt is false");
  legs[0].agent = SKITTER_NO_AGENT;
  REFUSED(skitter_crowd_hurt(crowd, legs, 1), "herd");
  REFUSED(skitter_crowd_hurt(crowd, NULL, 1), "legs is NULL");
  REFUSED(skitter_crowd_heal(crowd, other), "hurt is false");
  REFUSED(skitter_crowd_leg_state(crowd, ids[1], 8, &state), "leg is 8");
  REFUSED(skitter_crowd_leg_state(crowd, ids[1], 0, NULL), "state is NULL");
  OK(skitter_crowd_destroy(crowd));
  testSearches(device);
  OK(skitter_device_destroy(device));
}

static void testThreats(skitter_crowd* crowd) {
  const float centre[2] = {100, 0};
  OK(skitter_crowd_set_threat(crowd, 63, centre, 2));
  OK(skitter_crowd_set_threat(crowd, 63, centre, 0));
  REFUSED(skitter_crowd_set_threat(crowd, 64, centre, 2), "threat 64: expected a number less than 64");
  REFUSED(skitter_crowd_set_threat(crowd, 0, centre, -1), "threat 0.radius is -1");
  REFUSED(skitter_crowd_set_threat(crowd, 0, NULL, 1), "centre is NULL");
}

static void testPushes(skitter_crowd* crowd, const skitter_agent_id* ids) {
  const float velocity[2] = {1, 0};
  skitter_reaction reactions[6];
  int i;
  REFUSED(skitter_crowd_push(crowd, ids, velocity, 1), "reactions is false, expected a herd with reactions");
  REFUSED(skitter_crowd_push(crowd, NULL, velocity, 1), "agents is NULL");
  REFUSED(skitter_crowd_push(crowd, ids, NULL, 1), "velocities is NULL");
  REFUSED(skitter_crowd_reactions(crowd, 0, NULL, 6), "reactions is NULL");
  OK(skitter_crowd_reactions(crowd, 0, reactions, 6));
  for (i = 0; i < 6; ++i) CHECK(reactions[i].phase == SKITTER_REACTION_STEADY && reactions[i].falls == 0);
}

static void testComingAndGoing(skitter_crowd* crowd) {
  skitter_place place = {5, -5, 1};
  skitter_goal goal = {0};
  skitter_agent_id first = 0, second = 0, again = 0, ids[6];
  double places[6 * 3];
  uint32_t agents = 0, all = 0;
  int is = 0;
  OK(skitter_crowd_add(crowd, 0, &place, NULL, &first));
  place.x = -5;
  goal.kind = SKITTER_GOAL_NONE;
  OK(skitter_crowd_add(crowd, 0, &place, &goal, &second));
  REFUSED(skitter_crowd_add(crowd, 0, &place, &goal, NULL), "all of its 6 places are taken");
  REFUSED(skitter_crowd_add(crowd, 0, NULL, &goal, NULL), "place is NULL");
  OK(skitter_crowd_step(crowd, 1, dt));
  OK(skitter_crowd_herd_agents(crowd, 0, &agents));
  OK(skitter_crowd_herd_places(crowd, 0, &all));
  CHECK(agents == 6 && all == 6);
  OK(skitter_crowd_agent_ids(crowd, 0, ids, 6));
  CHECK(ids[4] == first && ids[5] == second);
  OK(skitter_crowd_positions(crowd, 0, places, 6));
  CHECK(hypot(places[12] - 5, places[14] + 5) < 0.05 && hypot(places[15] + 5, places[17] + 5) < 0.05);

  OK(skitter_crowd_remove(crowd, first));
  OK(skitter_crowd_has(crowd, first, &is));
  CHECK(!is);
  OK(skitter_crowd_has(crowd, second, &is));
  CHECK(is);
  REFUSED(skitter_crowd_remove(crowd, first), "nobody");
  OK(skitter_crowd_step(crowd, 1, dt));
  OK(skitter_crowd_positions(crowd, 0, places, 6));
  CHECK(places[13] < -9e5 && places[16] > -1);
  OK(skitter_crowd_add(crowd, 0, &place, NULL, &again));
  CHECK(again != first);
  OK(skitter_crowd_has(crowd, first, &is));
  CHECK(!is);
}

static void testSteering(void) {
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowdOf(standing, device, NULL);
  skitter_goal goal = {0}, goals[6] = {{0}};
  skitter_place place = {3, -4, 1};
  skitter_agent_id ids[6], id = 0;
  double ways[4][2], places[6 * 3];
  float headings[6];
  uint32_t agents = 0, all = 0;
  int i, is = 0;

  OK(skitter_crowd_herd_agents(crowd, 0, &agents));
  OK(skitter_crowd_herd_places(crowd, 0, &all));
  CHECK(agents == 4 && all == 6);
  REFUSED(skitter_crowd_agent_ids(crowd, 0, ids, 5), "room for 5, expected 6");
  OK(skitter_crowd_agent_ids(crowd, 0, ids, 6));
  for (i = 0; i < 6; ++i) CHECK((ids[i] == SKITTER_NO_AGENT) == (i >= 4));
  OK(skitter_crowd_agent_id(crowd, 0, 3, &id));
  CHECK(id == ids[3] && id != ids[0]);
  REFUSED(skitter_crowd_agent_id(crowd, 0, 4, &id), "herd 0, agent 4");
  OK(skitter_crowd_has(crowd, ids[3], &is));
  CHECK(is);
  OK(skitter_crowd_has(crowd, SKITTER_NO_AGENT, &is));
  CHECK(!is);

  /* All, each, and some. */
  goal.kind = SKITTER_GOAL_VELOCITY;
  goal.velocity[1] = 1;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  waysOf(crowd, 60, ways);
  for (i = 0; i < 4; ++i) CHECK(ways[i][1] > 0.3 && fabs(ways[i][0]) < 0.1);
  for (i = 0; i < 6; ++i) goals[i].kind = SKITTER_GOAL_NONE;
  goals[1].kind = SKITTER_GOAL_POINT;
  goals[1].target[0] = 1.25f;
  goals[1].target[1] = 10;
  goals[1].speed = 0.5f;
  REFUSED(skitter_crowd_steer_each(crowd, 0, goals, 4), "found 4 goals, expected 6, one a place");
  REFUSED(skitter_crowd_steer_each(crowd, 0, NULL, 6), "goals is NULL");
  OK(skitter_crowd_steer_each(crowd, 0, goals, 6));
  OK(skitter_crowd_step(crowd, 60, dt));
  waysOf(crowd, 60, ways);
  for (i = 0; i < 4; ++i) CHECK(fabs(ways[i][1] - (i == 1 ? 0.5 : 0)) < 0.1);
  goals[0] = goal;
  goals[1].kind = SKITTER_GOAL_NONE;
  OK(skitter_crowd_steer_agents(crowd, ids, goals, 2));
  OK(skitter_crowd_step(crowd, 60, dt));
  waysOf(crowd, 60, ways);
  for (i = 0; i < 4; ++i) CHECK(fabs(ways[i][1] - (i == 0 ? 1 : 0)) < 0.2);
  REFUSED(skitter_crowd_steer_agents(crowd, NULL, goals, 1), "agents is NULL");
  REFUSED(skitter_crowd_steer_agents(crowd, ids + 4, goals, 1), "herd 1023");
  REFUSED(skitter_crowd_steer(crowd, 0, NULL), "goal is NULL");
  REFUSED(skitter_crowd_steer(crowd, 1, &goal), "herd 1: expected one of the crowd's 1 herds");
  goals[0].velocity[0] = 1001;
  REFUSED(skitter_crowd_steer(crowd, 0, &goals[0]), "the length of goal.velocity");
  goals[0].kind = (skitter_goal_kind)8;
  REFUSED(skitter_crowd_steer(crowd, 0, &goals[0]), "goal.kind is 8, expected a skitter_goal_kind");
  goals[0].kind = SKITTER_GOAL_FLEE;
  REFUSED(skitter_crowd_steer(crowd, 0, &goals[0]), "expected a herd with ways");
  OK(skitter_crowd_steer_agents(crowd, NULL, NULL, 0));

  OK(skitter_crowd_steer(crowd, 0, &goal));
  testSpeeds(crowd, ids);
  testThreats(crowd);
  testPushes(crowd, ids);

  OK(skitter_crowd_teleport(crowd, ids + 2, &place, 1));
  OK(skitter_crowd_step(crowd, 1, dt));
  OK(skitter_crowd_positions(crowd, 0, places, 6));
  OK(skitter_crowd_headings(crowd, 0, headings, 6));
  CHECK(hypot(places[6] - 3, places[8] + 4) < 0.05 && fabs(headings[2] - 1) < 0.1);
  place.x = 100;
  REFUSED(skitter_crowd_teleport(crowd, ids + 2, &place, 1), "x is 100 m, expected -16 to 16");
  REFUSED(skitter_crowd_teleport(crowd, ids + 2, NULL, 1), "places is NULL");

  testComingAndGoing(crowd);
  OK(skitter_crowd_destroy(crowd));
  crowd = makeCrowd(device, NULL);
  place.x = 0;
  REFUSED(skitter_crowd_add(crowd, 0, &place, NULL, NULL), "its reserve is 0");
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

/* Four who find their way, and one who stands; a wall over the whole ground is north of them. */
static const char* const walled =
    "{\"terrain\": {\"columns\": 65, \"rows\": 65, \"amplitude\": 0},"
    " \"obstacles\": [{\"capsule\": {\"from\": [-40, 6], \"to\": [40, 6], \"radius\": 0.3}}],"
    " \"herds\": [{\"agents\": 4, \"ways\": {}, \"spawn\": {\"kind\": \"grid\"},"
    " \"goal\": {\"kind\": \"point\", \"target\": [0, 10]}},"
    " {\"agents\": 1, \"spawn\": {\"kind\": \"grid\", \"centre\": [6, -2]}, \"goal\": {\"kind\": "
    "\"none\"}}]}";

/* The farthest that one of four agents is from a place. */
static double farthestFrom(const skitter_crowd* crowd, double x, double z) {
  double places[4 * 3], farthest = 0;
  int i;
  OK(skitter_crowd_positions(crowd, 0, places, 4));
  for (i = 0; i < 4; ++i) farthest = fmax(farthest, hypot(places[3 * i] - x, places[3 * i + 2] - z));
  return farthest;
}

static void testRefusedSeries(skitter_crowd* crowd) {
  static const float places[6] = {0, 4, -5, 3, NAN, 1};
  skitter_goal goal = {0};
  goal.kind = SKITTER_GOAL_ROUTE;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "goal.place_count is 0, expected 1 to 16");
  goal.place_count = 17;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "goal.place_count is 17, expected 1 to 16");
  goal.place_count = 3;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "goal.places is NULL");
  goal.places = places;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "a goal.places x is nan m, expected -4096 to 4096");
  goal.kind = SKITTER_GOAL_ROAM;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "goal.radius is 0 m, expected 0.01 to 4096");
  goal.kind = SKITTER_GOAL_FOLLOW;
  goal.herd = 2;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "herd 2: expected one of the crowd's 2 herds");
  goal.herd = 1;
  goal.follow_agent = 1;
  goal.agent = 1;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal),
          "goal.agent is 1, expected less than 1, the places of herd 1");
}

/* Goals from place to place, while the crowd runs. */
static void testSeries(skitter_crowd* crowd) {
  const float places[4] = {0, 4, -5, 3}, here[2] = {-5, 3};
  skitter_goal goal = {0};
  double before[4 * 3], after[4 * 3];
  int i, on = 0;

  goal.kind = SKITTER_GOAL_ROUTE;
  goal.speed = 2;
  goal.places = places;
  goal.place_count = 2;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  OK(skitter_crowd_step(crowd, 600, dt));
  CHECK(farthestFrom(crowd, -5, 3) < 1);
  /* In a loop nobody stands. */
  goal.loop = 1;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  OK(skitter_crowd_step(crowd, 60, dt));
  OK(skitter_crowd_positions(crowd, 0, before, 4));
  OK(skitter_crowd_step(crowd, 30, dt));
  OK(skitter_crowd_positions(crowd, 0, after, 4));
  for (i = 0; i < 4; ++i)
    on += hypot(after[3 * i] - before[3 * i], after[3 * i + 2] - before[3 * i + 2]) > 0.2;
  CHECK(on >= 2);

  goal.kind = SKITTER_GOAL_ROAM;
  goal.target[0] = 3;
  goal.target[1] = -4;
  goal.radius = 3;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  OK(skitter_crowd_step(crowd, 600, dt));
  CHECK(farthestFrom(crowd, 3, -4) < 3 + 2);

  /* The middle of herd 1, and its only agent, which is there. */
  for (i = 0; i < 2; ++i) {
    goal.kind = SKITTER_GOAL_FOLLOW;
    goal.herd = 1;
    goal.follow_agent = i;
    goal.agent = 0;
    OK(skitter_crowd_steer(crowd, 0, &goal));
    OK(skitter_crowd_step(crowd, 900, dt));
    CHECK(farthestFrom(crowd, 6, -2) < 1.5);
    goal.kind = SKITTER_GOAL_POINT;
    goal.target[0] = here[0];
    goal.target[1] = here[1];
    OK(skitter_crowd_steer(crowd, 0, &goal));
    OK(skitter_crowd_step(crowd, 900, dt));
    CHECK(farthestFrom(crowd, here[0], here[1]) < 1);
  }

  goal.kind = SKITTER_GOAL_FLEE;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  OK(skitter_crowd_set_threat(crowd, 0, here, 2));
  OK(skitter_crowd_step(crowd, 300, dt));
  OK(skitter_crowd_positions(crowd, 0, after, 4));
  for (i = 0; i < 4; ++i) CHECK(hypot(after[3 * i] - here[0], after[3 * i + 2] - here[1]) > 2);
}

/* Goals that no way leads to, goals that are none, and goals in series. */
static void testWays(void) {
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowdOf(walled, device, NULL);
  skitter_goal goal = {0};
  uint32_t agents = 9;

  OK(skitter_crowd_cannot_reach(crowd, 0, &agents));
  CHECK(agents == 4);
  OK(skitter_crowd_cannot_reach(crowd, 1, &agents));
  CHECK(agents == 0);
  REFUSED(skitter_crowd_cannot_reach(crowd, 0, NULL), "agents is NULL");
  REFUSED(skitter_crowd_cannot_reach(crowd, 2, &agents), "herd 2: expected one of the crowd's 2 herds");
  goal.kind = SKITTER_GOAL_POINT;
  goal.speed = 1;
  goal.target[1] = -8;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  OK(skitter_crowd_step(crowd, 1, dt));
  OK(skitter_crowd_cannot_reach(crowd, 0, &agents));
  CHECK(agents == 0);
  goal.target[1] = NAN;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "herd 0: goal.target z is nan m, expected -4096 to 4096");
  goal.kind = SKITTER_GOAL_VELOCITY;
  goal.velocity[0] = NAN;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "herd 0: the length of goal.velocity is nan m/s");
  goal.kind = SKITTER_GOAL_CROSS;
  goal.speed = NAN;
  REFUSED(skitter_crowd_steer(crowd, 0, &goal), "herd 0: goal.speed is nan m/s, expected 0 to 1000");

  testRefusedSeries(crowd);
  testSeries(crowd);
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

static void testPicking(const skitter_crowd* crowd) {
  const double down[3] = {0, -1, 0}, nowhere[3] = {0, 0, 0};
  double places[6 * 3], above[3];
  skitter_picked picked = {9, 9, 9, {9, 9, 9}};
  int found = 0;
  OK(skitter_crowd_positions(crowd, 0, places, 6));
  above[0] = places[6];
  above[1] = places[7] + 10;
  above[2] = places[8];
  OK(skitter_crowd_pick(crowd, above, down, 1, &picked, &found));
  CHECK(!found && picked.herd == 9 && picked.place[2] == 9);
  OK(skitter_crowd_pick(crowd, above, down, INFINITY, &picked, &found));
  CHECK(found && picked.herd == 0 && picked.agent == 2 && picked.distance > 5 && picked.distance < 10);
  CHECK(fabs(picked.place[1] - (above[1] - picked.distance)) < 1e-6);
  OK(skitter_crowd_nearest(crowd, above, &picked, &found));
  CHECK(found && picked.agent == 2 && apart(picked.place, above) < 0.1);
  REFUSED(skitter_crowd_pick(crowd, above, nowhere, 1, &picked, &found), "direction is (0, 0, 0)");
  REFUSED(skitter_crowd_pick(crowd, above, down, -1, &picked, &found), "length is -1");
  REFUSED(skitter_crowd_pick(crowd, NULL, down, 1, &picked, &found), "start is NULL");
  REFUSED(skitter_crowd_nearest(crowd, above, NULL, &found), "picked is NULL");
  above[0] = NAN;
  REFUSED(skitter_crowd_nearest(crowd, above, &picked, &found), "point is (nan");
}

/* Herds that come and go, ground that is edited, and who is where. */
static void testHerds(void) {
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowdOf(standing, device, NULL);
  skitter_scene* scene = NULL;
  skitter_herd_id herd = {9, 9}, first = {9, 9};
  double places[6 * 3];
  float* heights;
  uint32_t herds = 0, agents = 0;
  uint64_t all = 0;
  int is = 0, i;

  NEED(skitter_scene_parse(twoHerds, NULL, &scene));
  REFUSED(skitter_crowd_add_herd(crowd, scene, 2, &herd), "herd 2: the scene has 2");
  REFUSED(skitter_crowd_add_herd(crowd, NULL, 1, &herd), "scene is NULL");
  NEED(skitter_crowd_add_herd(crowd, scene, 1, &herd));
  OK(skitter_scene_destroy(scene));
  OK(skitter_crowd_herds(crowd, &herds));
  OK(skitter_crowd_agent_count(crowd, &all));
  CHECK(herd.herd == 1 && herds == 2 && all == 7);
  OK(skitter_crowd_herd_id(crowd, 0, &first));
  CHECK(first.herd == 0);
  OK(skitter_crowd_has_herd(crowd, herd, &is));
  CHECK(is);
  OK(skitter_crowd_step(crowd, 2, dt));
  OK(skitter_crowd_positions(crowd, 1, places, 3));
  OK(skitter_crowd_remove_herd(crowd, herd));
  OK(skitter_crowd_has_herd(crowd, herd, &is));
  CHECK(!is);
  REFUSED(skitter_crowd_remove_herd(crowd, herd), "herd 1 of generation 0");
  REFUSED(skitter_crowd_herd_id(crowd, 1, &herd), "herd 1: was removed");
  OK(skitter_crowd_herd_places(crowd, 1, &agents));
  CHECK(agents == 0);
  OK(skitter_crowd_step(crowd, 1, dt));

  heights = malloc(65 * 65 * sizeof *heights);
  if (heights == NULL) exit(1);
  for (i = 0; i < 65 * 65; ++i) heights[i] = 0.5f;
  REFUSED(skitter_crowd_edit_heights(crowd, 64, 0, 2, 1, heights), "leaves the 65 x 65");
  REFUSED(skitter_crowd_edit_heights(crowd, 0, 0, 2, 1, NULL), "heights is NULL");
  OK(skitter_crowd_edit_heights(crowd, 0, 0, 65, 65, heights));
  free(heights);
  OK(skitter_crowd_step(crowd, 60, dt));
  OK(skitter_crowd_positions(crowd, 0, places, 6));
  for (i = 0; i < 4; ++i) CHECK(fabs(places[3 * i + 1] - 0.5) < 0.1);
  testPicking(crowd);
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

/* The state hash so many ticks after a state. */
static uint64_t hashAfter(skitter_device* device, const skitter_state* state,
                          const skitter_crowd_options* options, uint64_t ticks) {
  skitter_crowd* crowd = NULL;
  uint64_t hash = 0;
  float seconds = 0;
  OK(skitter_state_dt(state, &seconds));
  NEED(skitter_crowd_resume(device, state, options, &crowd));
  OK(skitter_crowd_step(crowd, ticks, seconds));
  OK(skitter_crowd_state_hash(crowd, &hash));
  OK(skitter_crowd_destroy(crowd));
  return hash;
}

static void testStateInMemory(skitter_device* device, const skitter_crowd* crowd, uint64_t hash) {
  skitter_state* state = NULL;
  skitter_crowd* resumed = NULL;
  const char* note = NULL;
  unsigned char* bytes;
  size_t size = 0, written = 0;
  OK(skitter_crowd_save_to_memory(crowd, NULL, NULL, 0, &size));
  CHECK(size > 65 * 65 * 4);
  bytes = malloc(size);
  if (bytes == NULL) exit(1);
  REFUSED(skitter_crowd_save_to_memory(crowd, NULL, bytes, size - 1, &written), "bytes has room for");
  CHECK(written == size);
  REFUSED(skitter_crowd_save_to_memory(crowd, NULL, NULL, size, &written), "bytes is NULL");
  OK(skitter_crowd_save_to_memory(crowd, NULL, bytes, size, &written));
  CHECK(written == size);
  NEED(skitter_state_parse(bytes, size, &state));
  OK(skitter_state_note(state, &note));
  CHECK(strcmp(note, "") == 0);
  REFUSED(skitter_state_parse(bytes, size - 1, &state), "it is not whole");
  /* The state has a copy. */
  memset(bytes, 0, size);
  CHECK(hashAfter(device, state, NULL, 20) == hash);
  OK(skitter_state_destroy(state));

  OK(skitter_crowd_save_to_memory(crowd, NULL, bytes, size, &written));
  bytes[size - 1000] ^= 1;
  NEED(skitter_state_parse(bytes, size, &state));
  REFUSED(skitter_crowd_resume(device, state, NULL, &resumed), "is damaged: the checksum differs");
  CHECK(resumed == NULL);
  OK(skitter_state_destroy(state));
  free(bytes);
}

static void testState(void) {
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowd(device, NULL);
  skitter_crowd_options options = {0};
  skitter_goal goal = {0};
  skitter_state* state = NULL;
  const char* note = NULL;
  uint64_t tick = 0, hash = 0;
  float seconds = 0;

  OK(skitter_crowd_step(crowd, 20, dt));
  /* A goal that waits for the next tick is in the state, too. */
  goal.kind = SKITTER_GOAL_VELOCITY;
  goal.velocity[0] = 1;
  OK(skitter_crowd_steer(crowd, 0, &goal));
  REFUSED(skitter_crowd_save(crowd, NULL, NULL), "file is NULL");
  REFUSED(skitter_crowd_save(crowd, "/no/such/folder/c_test.state", NULL), "/no/such/folder/c_test.state");
  OK(skitter_crowd_save(crowd, "c_test.state", "{\"level\": 3}"));
  REFUSED(skitter_crowd_save(crowd, "c_test.state", "{level"), "the note of a state is not JSON");
  NEED(skitter_state_load("c_test.state", &state));
  remove("c_test.state");
  OK(skitter_state_tick(state, &tick));
  OK(skitter_state_dt(state, &seconds));
  OK(skitter_state_note(state, &note));
  CHECK(tick == 20 && seconds == dt && strcmp(note, "{\"level\":3}") == 0);
  {
    skitter_scene* scene = NULL;
    uint32_t herds = 0, agents = 0;
    REFUSED(skitter_state_scene(state, NULL), "scene is NULL");
    NEED(skitter_state_scene(state, &scene));
    OK(skitter_scene_herds(scene, &herds));
    OK(skitter_scene_agents(scene, 1, &agents));
    CHECK(herds == 2 && agents == 3);
    OK(skitter_scene_destroy(scene));
  }
  REFUSED(skitter_crowd_resume(device, NULL, NULL, &crowd), "state is NULL");

  {
    skitter_crowd* plain = makeCrowd(device, NULL);
    uint64_t other = 0;
    OK(skitter_crowd_step(plain, 20, dt));
    OK(skitter_crowd_steer(plain, 0, &goal));
    OK(skitter_crowd_step(plain, 20, dt));
    OK(skitter_crowd_state_hash(plain, &hash));
    OK(skitter_crowd_destroy(plain));
    CHECK(hashAfter(device, state, NULL, 20) == hash);
    CHECK(hashAfter(device, state, NULL, 19) != hash);
    /* Other options, but for figures. */
    options.no_poses = options.no_figures = 1;
    options.footfalls = 100;
    CHECK(hashAfter(device, state, &options, 20) == hash);
    NEED(skitter_crowd_resume(device, state, &options, &plain));
    OK(skitter_crowd_step(plain, 20, dt));
    OK(skitter_crowd_state_hash(plain, &other));
    CHECK(other == hash);
    {
      skitter_fidelity fidelity;
      double joint[3];
      OK(skitter_crowd_fidelity(plain, SKITTER_ALL_HERDS, &fidelity));
      CHECK(fidelity.agent_ticks == 23 * 40);
      REFUSED(skitter_crowd_joints(plain, 1, joint, 3 * 8 * 5), "made with poses");
    }
    OK(skitter_crowd_destroy(plain));
  }
  OK(skitter_state_destroy(state));
  testStateInMemory(device, crowd, hash);
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

/* A device of the program's own, with what Skitter asks for. */
typedef struct host {
  VkInstance instance;
  VkPhysicalDevice physical;
  VkDevice device;
  VkQueue queue;
  uint32_t family;
  VkCommandPool pool;
  VkCommandBuffer commands;
} host;

#define VK(call)                \
  do {                          \
    if ((call) != VK_SUCCESS) { \
      fail(__LINE__, #call);    \
      exit(1);                  \
    }                           \
  } while (0)

/* What the host's device is made with, and what the engine is told of it. */
static VkPhysicalDeviceVulkan13Features v13 = {.sType =
                                                   VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
static VkPhysicalDeviceVulkan12Features v12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                               .pNext = &v13};
static VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                             .pNext = &v12};

static host makeHost(void) {
  host h;
  VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
  VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  VkPhysicalDevice devices[16];
  VkQueueFamilyProperties families[16];
  VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  skitter_device_info infos[16];
  uint32_t count = COUNT(devices), familyCount = COUNT(families), known = 0, i;
  const float priority = 1;
  const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;

  application.apiVersion = VK_API_VERSION_1_3;
  instance.pApplicationInfo = &application;
  VK(vkCreateInstance(&instance, NULL, &h.instance));
  if (vkEnumeratePhysicalDevices(h.instance, &count, devices) < 0 || count == 0) exit(1);
  NEED(skitter_device_list(infos, COUNT(infos), &known));
  h.physical = devices[0];
  for (i = 0; i < known && i < count; ++i)
    if (infos[i].chosen) h.physical = devices[infos[i].index];
  vkGetPhysicalDeviceQueueFamilyProperties(h.physical, &familyCount, families);
  h.family = 0;
  while (h.family + 1 < familyCount && (families[h.family].queueFlags & both) != both) ++h.family;

  REFUSED(skitter_add_features(NULL, h.physical), "chain is NULL");
  REFUSED(skitter_add_features(&features, NULL), "device is NULL");
  OK(skitter_add_features(&features, h.physical));
  queue.queueFamilyIndex = h.family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  device.pNext = &features;
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  VK(vkCreateDevice(h.physical, &device, NULL, &h.device));
  vkGetDeviceQueue(h.device, h.family, 0, &h.queue);
  pool.queueFamilyIndex = h.family;
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  VK(vkCreateCommandPool(h.device, &pool, NULL, &h.pool));
  commands.commandPool = h.pool;
  commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  commands.commandBufferCount = 1;
  VK(vkAllocateCommandBuffers(h.device, &commands, &h.commands));
  return h;
}

static void closeHost(const host* h) {
  vkDestroyCommandPool(h->device, h->pool, NULL);
  vkDestroyDevice(h->device, NULL);
  vkDestroyInstance(h->instance, NULL);
}

static void begin(const host* h) {
  VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  VK(vkBeginCommandBuffer(h->commands, &begin));
}

static void submit(const host* h) {
  VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &h->commands;
  VK(vkEndCommandBuffer(h->commands));
  VK(vkQueueSubmit(h->queue, 1, &info, VK_NULL_HANDLE));
  VK(vkQueueWaitIdle(h->queue));
}

static int locks = 0, depth = 0;
static void lockQueue(void* user) {
  CHECK(user == &locks && ++depth == 1);
  ++locks;
}
static void unlockQueue(void* user) { CHECK(user == &locks && --depth == 0); }

static skitter_device* adopt(const host* h) {
  skitter_adoption from;
  skitter_device* device = NULL;
  memset(&from, 0, sizeof from);
  from.instance = h->instance;
  from.physical_device = h->physical;
  from.device = h->device;
  from.queue_family = h->family;
  from.queue = h->queue;
  REFUSED(skitter_device_adopt(&from, &device), "from->features is NULL");
  from.features = &features;
  from.lock_queue = lockQueue;
  CHECK(skitter_device_adopt(&from, &device) == SKITTER_ERROR_DEVICE);
  CHECK(strstr(skitter_last_error(), "unlockQueue") != NULL);
  from.unlock_queue = unlockQueue;
  from.user = &locks;
  v13.maintenance4 = VK_FALSE;
  CHECK(skitter_device_adopt(&from, &device) == SKITTER_ERROR_DEVICE);
  CHECK(strstr(skitter_last_error(), "was made without maintenance4") != NULL);
  v13.maintenance4 = VK_TRUE;
  CHECK(locks == 0);
  NEED(skitter_device_adopt(&from, &device));
  CHECK(locks > 0);
  return device;
}

static void testAdoption(void) {
  host h = makeHost();
  skitter_device* ours = adopt(&h);
  skitter_crowd* crowd = makeCrowd(ours, NULL);
  uint64_t hash = 0, again = 0;
  int i;

  REFUSED(skitter_crowd_record(crowd, NULL, dt), "commands is NULL");
  for (i = 0; i < 10; ++i) {
    begin(&h);
    OK(skitter_crowd_record(crowd, h.commands, dt));
    submit(&h);
  }
  OK(skitter_crowd_state_hash(crowd, &hash));
  OK(skitter_crowd_destroy(crowd));

  /* On our own device, by our own submissions: the same. */
  {
    skitter_device* own = openDevice();
    crowd = makeCrowd(own, NULL);
    OK(skitter_crowd_step(crowd, 10, dt));
    OK(skitter_crowd_state_hash(crowd, &again));
    CHECK(hash == again);
    OK(skitter_crowd_destroy(crowd));
    OK(skitter_device_destroy(own));
  }
  OK(skitter_device_destroy(ours));
  closeHost(&h);
}

/* The ground, as edited: a slope of a quarter along x. */
static void testGround(void) {
  skitter_device* device = openDevice();
  skitter_crowd* crowd = makeCrowdOf(standing, device, NULL);
  static float heights[65 * 65], read[65 * 65];
  skitter_terrain terrain = {0};
  float height = 9, normal[3] = {0};
  int i;

  OK(skitter_crowd_terrain(crowd, &terrain));
  CHECK(terrain.columns == 65 && terrain.rows == 65 && terrain.spacing_x == 0.5f);
  CHECK(terrain.spacing_z == 0.5f);
  REFUSED(skitter_crowd_terrain(crowd, NULL), "terrain is NULL");
  OK(skitter_crowd_ground(crowd, 3, 4, &height, normal));
  CHECK(height == 0 && normal[0] == 0 && normal[1] == 1 && normal[2] == 0);

  for (i = 0; i < 65 * 65; ++i) heights[i] = 0.125f * (float)(i % 65);
  OK(skitter_crowd_edit_heights(crowd, 0, 0, 65, 65, heights));
  REFUSED(skitter_crowd_heights(crowd, read, COUNT(read) - 1), "heights has room for 4224, expected 4225");
  REFUSED(skitter_crowd_heights(crowd, NULL, COUNT(read)), "heights is NULL");
  OK(skitter_crowd_heights(crowd, read, COUNT(read)));
  CHECK(memcmp(heights, read, sizeof read) == 0);
  /* Heights up to 8 m are float32s a few roundings of 5e-7 m off. */
  OK(skitter_crowd_ground(crowd, 3.3f, 4, &height, normal));
  CHECK(fabs(height - 0.25 * (3.3 + 16)) < 1e-5);
  CHECK(fabs(normal[0] + 0.25 / sqrt(1.0625)) < 1e-5 && fabs(normal[1] - 1 / sqrt(1.0625)) < 1e-5);
  OK(skitter_crowd_ground(crowd, 1000, 1000, &height, NULL));
  CHECK(height == 8);
  OK(skitter_crowd_ground(crowd, 0, 0, NULL, normal));
  REFUSED(skitter_crowd_ground(crowd, NAN, 0, &height, NULL), "the place is (nan");
  CHECK(height == 8);
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

/* A buffer of the host's that the device writes and the host reads. */
typedef struct host_buffer {
  VkBuffer buffer;
  VkDeviceMemory memory;
  void* bytes;
} host_buffer;

static host_buffer makeBuffer(const host* h, VkDeviceSize size) {
  const VkMemoryPropertyFlags wanted =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  VkMemoryAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  VkMemoryRequirements needs;
  VkPhysicalDeviceMemoryProperties memory;
  host_buffer made;
  uint32_t type = 0;
  info.size = size;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VK(vkCreateBuffer(h->device, &info, NULL, &made.buffer));
  vkGetBufferMemoryRequirements(h->device, made.buffer, &needs);
  vkGetPhysicalDeviceMemoryProperties(h->physical, &memory);
  while (type + 1 < memory.memoryTypeCount &&
         (!(needs.memoryTypeBits >> type & 1) || (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
    ++type;
  allocation.allocationSize = needs.size;
  allocation.memoryTypeIndex = type;
  VK(vkAllocateMemory(h->device, &allocation, NULL, &made.memory));
  VK(vkBindBufferMemory(h->device, made.buffer, made.memory, 0));
  VK(vkMapMemory(h->device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.bytes));
  return made;
}

static void freeBuffer(const host* h, const host_buffer* buffer) {
  vkDestroyBuffer(h->device, buffer->buffer, NULL);
  vkFreeMemory(h->device, buffer->memory, NULL);
}

/* After the recorded compute and transfer work, the host sees what it wrote. */
static void submitForHost(const host* h) {
  VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(h->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
  submit(h);
}

/* A range of a buffer of the engine's, in a buffer of the host's. */
static host_buffer copyOf(const host* h, VkBuffer from, VkDeviceSize offset, VkDeviceSize size) {
  host_buffer copy = makeBuffer(h, size);
  VkBufferCopy region = {0};
  region.srcOffset = offset;
  region.size = size;
  begin(h);
  vkCmdCopyBuffer(h->commands, from, copy.buffer, 1, &region);
  submitForHost(h);
  return copy;
}

/* The host's copies of a herd's buffers are what is downloaded: `floats` a record, `legs` records an agent.
 */
static void compareBuffers(const host* h, const skitter_crowd* crowd, skitter_record record, uint32_t floats,
                           uint32_t legs, const float* downloaded) {
  skitter_record_buffer buffers[8];
  uint32_t found = 0, at = 0, agent, leg;
  size_t count = 0, i;
  OK(skitter_crowd_buffers(crowd, 0, record, NULL, 0, &count));
  CHECK(count > 0 && count <= COUNT(buffers));
  OK(skitter_crowd_buffers(crowd, 0, record, buffers, COUNT(buffers), &count));
  for (i = 0; i < count; ++i) {
    const host_buffer copy = copyOf(h, buffers[i].buffer, buffers[i].offset, buffers[i].bytes);
    CHECK(4 * buffers[i].stride == floats && buffers[i].first_agent == found);
    for (agent = found; agent < found + buffers[i].agents; ++agent)
      for (leg = 0; leg < legs; ++leg) {
        OK(skitter_record_at(&buffers[i], agent, leg, &at));
        CHECK(memcmp((const char*)copy.bytes + (16 * (size_t)at - buffers[i].offset),
                     downloaded + (agent * legs + leg) * floats, floats * sizeof(float)) == 0);
      }
    REFUSED(skitter_record_at(&buffers[i], found + buffers[i].agents, 0, &at), "expected one of the page's");
    REFUSED(skitter_record_at(&buffers[i], found, legs, &at), "expected less than");
    REFUSED(skitter_record_at(&buffers[i], found, 0, NULL), "at is NULL");
    found += buffers[i].agents;
    freeBuffer(h, &copy);
  }
  CHECK(found == 20);
}

/* Bodies, poses and steps of 20 agents mean what the crowd says of them. */
static void testDecoding(const skitter_crowd* crowd, const float* bodies, const float* steps) {
  static float poses[20 * 33 * 8];
  static double joints[20 * 8 * 5 * 3];
  const double origin[3] = {5, -1, 7}, far[3] = {INFINITY, 0, 0};
  double places[20 * 3];
  float headings[20];
  skitter_body body, moved;
  skitter_bone bone;
  skitter_step step, other;
  float longer[8];
  size_t count = 0;
  int agent, leg, k;

  OK(skitter_crowd_positions(crowd, 0, places, 20));
  OK(skitter_crowd_headings(crowd, 0, headings, 20));
  OK(skitter_crowd_joints(crowd, 0, joints, 20 * 8 * 5));
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_POSE, poses, COUNT(poses), &count));
  CHECK(count == COUNT(poses));
  for (agent = 0; agent < 20; ++agent) {
    OK(skitter_decode_body(bodies + 16 * agent, NULL, &body));
    OK(skitter_decode_body(bodies + 16 * agent, origin, &moved));
    CHECK(memcmp(body.position, places + 3 * agent, sizeof body.position) == 0);
    for (k = 0; k < 3; ++k) CHECK(fabs(body.position[k] - moved.position[k] - origin[k]) < 1e-9);
    CHECK(fabs(atan2(body.heading[0], body.heading[1]) - headings[agent]) < 1e-6);
    CHECK(body.present == 1 && hypot(body.velocity[0], body.velocity[2]) < 2);
    for (leg = 0; leg < 8; ++leg) {
      const double* root = joints + 3 * (8 * 5 * agent + 5 * leg);
      OK(skitter_decode_bone(poses + 33 * 8 * agent, 33 * 8, (uint32_t)(1 + 4 * leg), &bone));
      for (k = 0; k < 3; ++k) CHECK(fabs(body.position[k] + bone.position[k] - root[k]) < 1e-9);
      /* A foot lands within a leg, 1 m, and a stride of its body. */
      OK(skitter_decode_step(steps + 8 * (8 * agent + leg), bodies + 16 * agent, NULL, &step));
      CHECK(apart(step.landing, body.position) < 2.5 && fabs(step.landing[1] - body.position[1]) < 2.5);
      memcpy(longer, steps + 8 * (8 * agent + leg), sizeof longer);
      longer[0] += 0.25f, longer[1] += 0.5f, longer[2] -= 0.25f;
      OK(skitter_decode_step(longer, bodies + 16 * agent, NULL, &other));
      CHECK(memcmp(other.lift_off, step.lift_off, sizeof step.lift_off) == 0);
      for (k = 0; k < 3; ++k)
        CHECK(fabs(other.landing[k] - other.lift_off[k] - ((double)longer[k] - longer[4 + k])) < 1e-9);
      CHECK(other.first_tick == longer[3]);
    }
  }
  REFUSED(skitter_decode_body(bodies, far, &body), "origin is (inf, 0, 0)");
  REFUSED(skitter_decode_bone(poses, 33 * 8, 33, &bone),
          "pose has 264 floats, expected at least 272 for entry 33");
}

static void testDecodingByHand(void) {
  static const float record[4] = {1, 2, 3, 0.5f};
  float pose[24], rows[12], event[8] = {4, 5, 6, 0.25f, 13, 7, 99, 0};
  skitter_body body = {{10, 20, 30}, {0}, {0}, {0}, 0, 1};
  skitter_foot foot;
  skitter_tip tip;
  skitter_footfall_buffer buffer = {0};
  skitter_footfall footfall = {0};
  int i, ours = 9;
  OK(skitter_decode_foot(record, &body, &foot));
  CHECK(foot.place[0] == 11 && foot.place[1] == 22 && foot.place[2] == 33 && foot.progress == 0.5f);
  OK(skitter_decode_tip(record, &body, &tip));
  CHECK(tip.place[0] == 11 && tip.place[1] == 22 && tip.place[2] == 33 && tip.error == 0.5f);
  for (i = 0; i < 24; ++i) pose[i] = (float)i;
  OK(skitter_decode_joint(pose, 24, 1, rows));
  CHECK(memcmp(rows, pose + 12, sizeof rows) == 0);
  REFUSED(skitter_decode_joint(pose, 23, 1, rows), "pose has 23 floats, expected at least 24 for joint 1");

  buffer.first_agent = 10;
  buffer.agents = 4;
  buffer.first_of_herd = 100;
  OK(skitter_decode_footfall(event, &buffer, &footfall, &ours));
  CHECK(ours && footfall.agent == 103 && footfall.leg == 7 && footfall.tick == 99);
  CHECK(footfall.place[0] == 4 && footfall.place[2] == 6 && footfall.speed == 0.25f);
  for (i = 0; i < 2; ++i) {
    event[4] = i ? 14.0f : 9.0f; /* the herds after and before */
    OK(skitter_decode_footfall(event, &buffer, &footfall, &ours));
    CHECK(!ours && footfall.agent == 103);
  }
}

static int contains(const skitter_footfall* list, size_t count, const skitter_footfall* one) {
  size_t i;
  for (i = 0; i < count; ++i)
    if (list[i].tick == one->tick && list[i].agent == one->agent && list[i].leg == one->leg &&
        list[i].speed == one->speed && memcmp(list[i].place, one->place, sizeof one->place) == 0)
      return 1;
  return 0;
}

/* The events on the device are the touchdowns of the last tick. */
static void testFootfallBuffers(const host* h, skitter_crowd* crowd) {
  skitter_footfall footfalls[20 * 8], footfall;
  skitter_footfall_buffer buffers[8];
  size_t count = 0, pages = 0, found = 0, i;
  int ticks, ours = 0;
  for (ticks = 0; ticks < 60 && count == 0; ++ticks) {
    OK(skitter_crowd_step(crowd, 1, dt));
    OK(skitter_crowd_footfalls(crowd, 0, footfalls, COUNT(footfalls), &count));
  }
  CHECK(count > 0);
  OK(skitter_crowd_footfall_buffers(crowd, 0, buffers, COUNT(buffers), &pages));
  CHECK(pages > 0 && pages <= COUNT(buffers));
  for (i = 0; i < pages; ++i) {
    const host_buffer number = copyOf(h, buffers[i].counters, buffers[i].count_offset, 4);
    const host_buffer events = copyOf(h, buffers[i].events, 0, 32 * (VkDeviceSize)buffers[i].room);
    const uint32_t all = *(const uint32_t*)number.bytes;
    uint32_t event;
    CHECK(all <= buffers[i].room);
    for (event = 0; event < all && event < buffers[i].room; ++event) {
      OK(skitter_decode_footfall((const float*)events.bytes + 8 * event, &buffers[i], &footfall, &ours));
      CHECK(!ours || contains(footfalls, count, &footfall));
      found += ours != 0;
    }
    freeBuffer(h, &number);
    freeBuffer(h, &events);
  }
  CHECK(found == count);
}

static void testRecords(void) {
  host h = makeHost();
  skitter_device* device = adopt(&h);
  skitter_crowd_options options = {0};
  skitter_crowd* crowd;
  static float bodies[20 * 16], steps[20 * 8 * 8];
  skitter_goal_buffer goals[8];
  uint32_t agents = 0;
  size_t count = 0, i;

  options.footfalls = 1000;
  crowd = makeCrowd(device, &options);
  OK(skitter_crowd_step(crowd, 30, dt));
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_BODY, NULL, 0, &count));
  CHECK(count == COUNT(bodies));
  REFUSED(skitter_crowd_records(crowd, 0, SKITTER_RECORD_BODY, bodies, COUNT(bodies) - 1, &count),
          "numbers has room for 319, expected 320");
  REFUSED(skitter_crowd_records(crowd, 0, SKITTER_RECORD_BODY, NULL, 1, &count), "numbers is NULL");
  REFUSED(skitter_crowd_records(crowd, 2, SKITTER_RECORD_BODY, NULL, 0, &count), "herd 2");
  REFUSED(skitter_crowd_records(crowd, 0, (skitter_record)1000, NULL, 0, &count),
          "record is 1000, expected a skitter_record");
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_BODY, bodies, COUNT(bodies), &count));
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_STEP, steps, COUNT(steps), &count));
  CHECK(count == COUNT(steps));
  compareBuffers(&h, crowd, SKITTER_RECORD_BODY, 16, 1, bodies);
  compareBuffers(&h, crowd, SKITTER_RECORD_STEP, 8, 8, steps);
  testDecoding(crowd, bodies, steps);
  testDecodingByHand();

  REFUSED(skitter_crowd_buffers(crowd, 2, SKITTER_RECORD_BODY, NULL, 0, &count), "herd 2");
  REFUSED(skitter_crowd_buffers(crowd, 0, SKITTER_RECORD_BODY, NULL, 1, &count), "buffers is NULL");
  REFUSED(skitter_crowd_buffers(crowd, 0, SKITTER_RECORD_BODY, NULL, 0, NULL), "count is NULL");
  REFUSED(skitter_crowd_buffers(crowd, 0, (skitter_record)31, NULL, 0, &count), "expected a skitter_record");
  OK(skitter_crowd_buffers(crowd, 0, SKITTER_RECORD_WATCH, NULL, 0, &count));
  CHECK(count == 0);
  OK(skitter_crowd_goal_buffers(crowd, 0, goals, COUNT(goals), &count));
  CHECK(count > 0 && count <= COUNT(goals));
  for (i = 0; i < count; ++i) {
    CHECK(goals[i].goals != VK_NULL_HANDLE && goals[i].first_agent == agents);
    agents += goals[i].agents;
  }
  CHECK(agents == 20);
  REFUSED(skitter_crowd_goal_buffers(crowd, 2, NULL, 0, &count), "herd 2");

  testFootfallBuffers(&h, crowd);
  REFUSED(skitter_crowd_footfall_buffers(crowd, 2, NULL, 0, &count), "herd 2");
  OK(skitter_crowd_destroy(crowd));
  crowd = makeCrowd(device, NULL);
  {
    skitter_footfall_buffer none = {0};
    none.room = 9;
    OK(skitter_crowd_footfall_buffers(crowd, 0, &none, 1, &count));
    CHECK(count > 0 && none.room == 0);
  }
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
  closeHost(&h);
}

/* What was taken of a tick, while the crowd is still after it. */
static void testTaken(const skitter_crowd* crowd, const skitter_readback* readback) {
  static double joints[20 * 8 * 5 * 3];
  const double origin[3] = {5, -1, 7}, down[3] = {0, -1, 0};
  double places[20 * 3], taken[20 * 3], least[3] = {0}, most[3] = {0}, above[3];
  const float* records = NULL;
  skitter_picked picked = {9, 9, 9, {9, 9, 9}}, same = {9, 9, 9, {9, 9, 9}};
  skitter_body body;
  uint32_t agents = 0;
  int found = 0, foundByCrowd = 0, i, k;

  OK(skitter_readback_places(readback, 0, &agents));
  CHECK(agents == 20);
  OK(skitter_readback_places(readback, 7, &agents));
  CHECK(agents == 0);
  OK(skitter_crowd_positions(crowd, 0, places, 20));
  REFUSED(skitter_readback_positions(readback, 0, NULL, taken, 19), "xyz has room for 19, expected 20");
  OK(skitter_readback_positions(readback, 0, NULL, taken, 20));
  CHECK(memcmp(places, taken, sizeof taken) == 0);
  OK(skitter_readback_positions(readback, 0, origin, taken, 20));
  for (i = 0; i < 60; ++i) CHECK(fabs(places[i] - taken[i] - origin[i % 3]) < 1e-9);
  OK(skitter_readback_bodies(readback, 0, &records));
  OK(skitter_decode_body(records + 16 * 19, NULL, &body));
  CHECK(memcmp(body.position, places + 3 * 19, sizeof body.position) == 0);

  OK(skitter_readback_bounds(readback, 0, NULL, least, most, &found));
  CHECK(found);
  OK(skitter_crowd_joints(crowd, 0, joints, 20 * 8 * 5));
  for (i = 0; i < 20 * 8 * 5; ++i)
    for (k = 0; k < 3; ++k) CHECK(joints[3 * i + k] >= least[k] && joints[3 * i + k] <= most[k]);
  OK(skitter_readback_bounds(readback, 7, NULL, least, most, &found));
  CHECK(!found);

  memcpy(above, places, sizeof above);
  above[1] += 10;
  OK(skitter_readback_pick(readback, above, down, INFINITY, &picked, &found));
  OK(skitter_crowd_pick(crowd, above, down, INFINITY, &same, &foundByCrowd));
  CHECK(found && foundByCrowd && picked.herd == same.herd && picked.agent == same.agent);
  CHECK(picked.distance == same.distance && picked.place[1] == same.place[1]);
  OK(skitter_readback_pick(readback, above, down, 1, &picked, &found));
  CHECK(!found);
  OK(skitter_readback_nearest(readback, above, &picked, &found));
  OK(skitter_crowd_nearest(crowd, above, &same, &foundByCrowd));
  CHECK(found && foundByCrowd && picked.herd == same.herd && picked.agent == same.agent);
  CHECK(picked.distance == same.distance && picked.distance < 10);
  REFUSED(skitter_readback_pick(readback, above, down, -1, &picked, &found), "length is -1");
  above[0] = NAN;
  REFUSED(skitter_readback_nearest(readback, above, &picked, &found), "point is (nan");
}

/* Copies in the host's own command buffer. */
static void testOwnReadback(const host* h, skitter_crowd* crowd) {
  skitter_readback_options options = {0};
  skitter_readback* readback = NULL;
  const uint32_t herds[2] = {1, 9};
  uint64_t tick = 0, before = 0, skipped = 0;
  uint32_t agents = 9;
  int found = 1, i;
  options.slots = 1;
  REFUSED(skitter_readback_create(crowd, &options, &readback), "1 slots, expected at least 2");
  options.slots = 2;
  options.herd_count = 2;
  REFUSED(skitter_readback_create(crowd, &options, &readback), "options->herds is NULL");
  options.herds = herds;
  REFUSED(skitter_readback_create(crowd, &options, &readback), "herd 9");
  REFUSED(skitter_readback_create(crowd, &options, NULL), "readback is NULL");
  options.herd_count = 1;
  NEED(skitter_readback_create(crowd, &options, &readback));
  OK(skitter_crowd_tick(crowd, &before));
  begin(h);
  REFUSED(skitter_readback_record(readback, NULL), "commands is NULL");
  for (i = 0; i < 3; ++i) {
    OK(skitter_crowd_record(crowd, h->commands, dt));
    OK(skitter_readback_record(readback, h->commands));
  }
  OK(skitter_readback_take(readback, &tick, &found));
  OK(skitter_readback_skipped(readback, &skipped));
  CHECK(!found && tick == 0 && skipped == 1);
  submit(h);
  OK(skitter_readback_take(readback, &tick, &found));
  CHECK(found && tick == before + 2);
  OK(skitter_readback_places(readback, 0, &agents));
  CHECK(agents == 0);
  OK(skitter_readback_places(readback, 1, &agents));
  CHECK(agents == 3);
  OK(skitter_readback_destroy(readback));
}

static void testReadback(void) {
  host h = makeHost();
  skitter_device* device = adopt(&h);
  skitter_crowd* crowd = makeCrowd(device, NULL);
  skitter_readback* readback = NULL;
  double places[20 * 3];
  uint64_t tick = 99, hash = 0;
  int found = 1;

  NEED(skitter_readback_create(crowd, NULL, &readback));
  OK(skitter_readback_take(readback, &tick, &found));
  CHECK(!found && tick == 99);
  REFUSED(skitter_readback_positions(readback, 0, NULL, places, 20), "nothing is taken");
  OK(skitter_readback_step(readback, 0, dt));
  OK(skitter_readback_step(readback, 10, dt));
  /* This waits for the ticks. */
  OK(skitter_crowd_state_hash(crowd, &hash));
  OK(skitter_readback_take(readback, &tick, &found));
  CHECK(found && tick == 10);
  testTaken(crowd, readback);
  REFUSED(skitter_readback_take(readback, NULL, &found), "tick is NULL");

  /* It is gone with the next copy. */
  OK(skitter_readback_step(readback, 1, dt));
  REFUSED(skitter_readback_positions(readback, 0, NULL, places, 20), "nothing is taken");
  REFUSED(skitter_readback_step(readback, 1, -1), "dt");
  testOwnReadback(&h, crowd);

  /* It keeps the crowd. */
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_readback_step(readback, 1, dt));
  OK(skitter_readback_destroy(readback));
  OK(skitter_device_destroy(device));
  closeHost(&h);
}

static void testSkinMesh(const skitter_crowd* crowd, uint32_t entries) {
  skitter_skin_mesh *mesh = NULL, *small = NULL;
  skitter_skin_vertex* vertices;
  uint32_t* indices;
  skitter_skin_level levels[16];
  skitter_space space = {SKITTER_AXES_LEFT_Y_UP, 0.01f};
  size_t vertexCount = 0, indexCount = 0, levelCount = 0, written = 0, i;
  float radius = 0, radiusOfSmall = 0;
  uint32_t sum = 0;
  int k;

  REFUSED(skitter_skin_mesh_create(crowd, 1, NULL, &mesh), "herd 1");
  REFUSED(skitter_skin_mesh_create(crowd, 0, NULL, NULL), "mesh is NULL");
  NEED(skitter_skin_mesh_create(crowd, 0, NULL, &mesh));
  OK(skitter_skin_mesh_vertices(mesh, NULL, 0, &vertexCount));
  OK(skitter_skin_mesh_indices(mesh, NULL, 0, &indexCount));
  OK(skitter_skin_mesh_levels(mesh, levels, COUNT(levels), &levelCount));
  REFUSED(skitter_skin_mesh_vertices(mesh, NULL, 1, &vertexCount), "vertices is NULL");
  REFUSED(skitter_skin_mesh_indices(mesh, NULL, 1, &indexCount), "indices is NULL");
  CHECK(vertexCount > 100 && indexCount > 300 && levelCount > 0 && levelCount <= COUNT(levels));
  vertices = malloc(vertexCount * sizeof *vertices);
  indices = malloc(indexCount * sizeof *indices);
  if (vertices == NULL || indices == NULL) exit(1);
  OK(skitter_skin_mesh_vertices(mesh, vertices, vertexCount, &written));
  OK(skitter_skin_mesh_indices(mesh, indices, indexCount, &written));
  OK(skitter_skin_mesh_radius(mesh, &radius));
  for (i = 0; i < vertexCount; ++i) {
    const skitter_skin_vertex* v = &vertices[i];
    /* Four float32s that were rounded to sum to 1. */
    CHECK(fabs(v->weights[0] + v->weights[1] + v->weights[2] + v->weights[3] - 1) < 1e-5);
    for (k = 0; k < 4; ++k) CHECK(v->bones[k] < entries);
    CHECK(fabs(v->position[0]) < radius && fabs(v->position[1]) < radius && fabs(v->position[2]) < radius);
  }
  for (i = 0; i < indexCount; ++i) CHECK(indices[i] < vertexCount);
  for (i = 0; i < levelCount; ++i) {
    CHECK(levels[i].first_index == sum && levels[i].index_count % 3 == 0);
    sum += levels[i].index_count;
  }
  CHECK(sum == indexCount && levels[levelCount - 1].pixels == 0);

  /* In centimetres, and with the left on the other side. */
  NEED(skitter_skin_mesh_create(crowd, 0, &space, &small));
  OK(skitter_skin_mesh_radius(small, &radiusOfSmall));
  CHECK(fabs(radiusOfSmall - 100 * radius) < 1e-4 * radiusOfSmall);
  {
    skitter_skin_vertex first;
    OK(skitter_skin_mesh_vertices(small, &first, 1, &written));
    CHECK(written == vertexCount);
    CHECK(fabs(first.position[0] + 100 * vertices[0].position[0]) < 1e-4 * radiusOfSmall);
    CHECK(fabs(first.position[1] - 100 * vertices[0].position[1]) < 1e-4 * radiusOfSmall);
  }
  space.metres_per_unit = -1;
  REFUSED(skitter_skin_mesh_create(crowd, 0, &space, &mesh), "space.metres_per_unit is -1");
  free(vertices);
  free(indices);
  OK(skitter_skin_mesh_destroy(mesh));
  OK(skitter_skin_mesh_destroy(small));
}

/* The rotation of a quaternion x, y, z, w: a row of its matrix. */
static void rowOf(const float* q, int row, double* to) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  memcpy(to, rows[row], sizeof rows[row]);
}

static void testRefusedPalettes(skitter_crowd* crowd, const skitter_palette_target* target) {
  skitter_palette_target wrong = *target;
  skitter_palette_options options = {{SKITTER_AXES_RIGHT_Y_UP, 0}, 0};
  skitter_palettes* palettes = NULL;
  REFUSED(skitter_palettes_create(crowd, 1, target, 1, NULL, &palettes), "herd 1");
  REFUSED(skitter_palettes_create(crowd, 0, NULL, 1, NULL, &palettes), "targets is NULL");
  REFUSED(skitter_palettes_create(crowd, 0, target, 1, NULL, NULL), "palettes is NULL");
  wrong.instances.bytes = 6 * 48 - 1;
  REFUSED(skitter_palettes_create(crowd, 0, &wrong, 1, NULL, &palettes), "287 bytes for 6 transforms");
  wrong = *target;
  wrong.palettes.format = (skitter_transform_format)2;
  REFUSED(skitter_palettes_create(crowd, 0, &wrong, 1, NULL, &palettes), "palettes.format is 2");
  options.space.axes = (skitter_axes)4;
  REFUSED(skitter_palettes_create(crowd, 0, target, 1, &options, &palettes), "space.axes is 4");
  options.space.axes = SKITTER_AXES_RIGHT_Y_UP;
  options.space.metres_per_unit = INFINITY;
  REFUSED(skitter_palettes_create(crowd, 0, target, 1, &options, &palettes), "space.metres_per_unit is inf");
  CHECK(palettes == NULL);
}

/* Six places, four of them taken: instances and palettes as matrices, and instances as quaternions. */
static void testDrawing(void) {
  enum { places = 6, bones = 33 };
  host h = makeHost();
  skitter_device* device = adopt(&h);
  skitter_crowd* crowd = makeCrowdOf(standing, device, NULL);
  skitter_palettes* palettes = NULL;
  skitter_palette_target targets[2];
  const double origin[3] = {1, -2, 3};
  const host_buffer mine = makeBuffer(&h, places * (48 + 48 * bones + 32));
  const float* matrices = mine.bytes;
  const float* skins = matrices + 12 * places;
  const float* quaternions = skins + 12 * bones * places;
  static float bodies[16 * places], poses[8 * bones * places];
  uint32_t entries = 0;
  size_t count = 0;
  skitter_body body;
  skitter_bone bone;
  double row[3];
  int i, k, r;

  OK(skitter_crowd_palette_entries(crowd, 0, &entries));
  CHECK(entries == bones);
  REFUSED(skitter_crowd_palette_entries(crowd, 1, &entries), "herd 1");
  memset(targets, 0, sizeof targets);
  targets[0].instances.buffer = targets[0].palettes.buffer = targets[1].instances.buffer = mine.buffer;
  targets[0].instances.bytes = 48 * places;
  targets[0].palettes.offset = 48 * places;
  targets[0].palettes.bytes = 48 * bones * places;
  targets[1].instances.offset = places * (48 + 48 * bones);
  targets[1].instances.bytes = 32 * places;
  targets[1].instances.format = SKITTER_TRANSFORM_QUATERNION;
  testRefusedPalettes(crowd, targets);
  NEED(skitter_palettes_create(crowd, 0, targets, 2, NULL, &palettes));

  memset(mine.bytes, 0x7f, places * (48 + 48 * bones + 32));
  begin(&h);
  OK(skitter_crowd_record(crowd, h.commands, dt));
  OK(skitter_palettes_record(palettes, h.commands, origin, 0));
  OK(skitter_palettes_record(palettes, h.commands, NULL, 1));
  REFUSED(skitter_palettes_record(palettes, h.commands, NULL, 2), "target is 2, the palettes have 2");
  REFUSED(skitter_palettes_record(palettes, NULL, NULL, 0), "commands is NULL");
  submitForHost(&h);
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_BODY, bodies, COUNT(bodies), &count));
  OK(skitter_crowd_records(crowd, 0, SKITTER_RECORD_POSE, poses, COUNT(poses), &count));
  /* Places are float32s within 32 m of the origin, 2e-6 m, and rotations are products of a few of them. */
  for (i = 0; i < places; ++i) {
    const float *matrix = matrices + 12 * i, *quaternion = quaternions + 8 * i;
    OK(skitter_decode_body(bodies + 16 * i, NULL, &body));
    CHECK(body.present == (i < 4));
    if (!body.present) {
      for (k = 0; k < 12; ++k) CHECK(matrix[k] == 0);
      for (k = 0; k < 8; ++k) CHECK(quaternion[k] == 0);
      continue;
    }
    for (r = 0; r < 3; ++r) {
      CHECK(fabs(matrix[4 * r + 3] - (body.position[r] - origin[r])) < 1e-5);
      CHECK(fabs(quaternion[4 + r] - body.position[r]) < 1e-5);
      rowOf(body.rotation, r, row);
      for (k = 0; k < 3; ++k) CHECK(fabs(matrix[4 * r + k] - row[k]) < 1e-5);
    }
    CHECK(quaternion[7] == 1);
    for (k = 0; k < bones; ++k) {
      OK(skitter_decode_bone(poses + 8 * bones * i, 8 * bones, (uint32_t)k, &bone));
      for (r = 0; r < 3; ++r) {
        const float* skin = skins + 12 * (bones * i + k) + 4 * r;
        rowOf(bone.rotation, r, row);
        CHECK(fabs(skin[0] - row[0]) < 1e-5 && fabs(skin[1] - row[1]) < 1e-5);
        CHECK(fabs(skin[2] - row[2]) < 1e-5);
      }
    }
  }
  testSkinMesh(crowd, entries);
  /* They keep the crowd. */
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_palettes_destroy(palettes));
  freeBuffer(&h, &mine);
  OK(skitter_device_destroy(device));
  closeHost(&h);
}

enum { pictureWidth = 64, pictureHeight = 48, pictureBytes = 4 * pictureWidth * pictureHeight };

/* Paints all of the picture red. */
static void paintRed(VkCommandBuffer commands, void* user) {
  VkClearAttachment red = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT};
  VkClearRect all = {.layerCount = 1};
  red.clearValue.color.float32[0] = red.clearValue.color.float32[3] = 1;
  all.rect.extent.width = pictureWidth;
  all.rect.extent.height = pictureHeight;
  vkCmdClearAttachments(commands, 1, &red, 1, &all);
  ++*(int*)user;
}

static void testRefusedViews(skitter_renderer* renderer, const skitter_view* view) {
  skitter_view wrong = *view;
  REFUSED(skitter_renderer_draw(renderer, NULL), "view is NULL");
  wrong.eye[1] = NAN;
  REFUSED(skitter_renderer_draw(renderer, &wrong), "view->eye is");
  memcpy(wrong.eye, wrong.target, sizeof wrong.eye);
  REFUSED(skitter_renderer_draw(renderer, &wrong), "view->target is where view->eye is");
  wrong = *view;
  wrong.field_of_view = 4;
  REFUSED(skitter_renderer_draw(renderer, &wrong), "view->field_of_view is 4");
}

static void testPng(const uint8_t* pixels) {
  unsigned char head[8] = {0};
  FILE* file;
  OK(skitter_write_png("c_test_picture.png", pictureWidth, pictureHeight, pixels));
  file = fopen("c_test_picture.png", "rb");
  CHECK(file != NULL && fread(head, 1, 8, file) == 8 && memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0);
  if (file != NULL) fclose(file);
  remove("c_test_picture.png");
  REFUSED(skitter_write_png("/no/such/folder/a.png", pictureWidth, pictureHeight, pixels),
          "/no/such/folder/a.png");
  REFUSED(skitter_write_png("a.png", 0, 5, pixels), "a.png: a picture of 0 x 5 pixels");
  REFUSED(skitter_write_png(NULL, 1, 1, pixels), "file is NULL");
  REFUSED(skitter_write_png("a.png", 1, 1, NULL), "rgba is NULL");
}

/* Copies a file of assets here. A broken one has another byte among the rows of its first PNG. */
static void copyAsset(const char* name, int broken) {
  static unsigned char bytes[1 << 20];
  char path[1024];
  size_t size, i;
  FILE* file;
  snprintf(path, sizeof path, "%s/%s", SKITTER_ASSETS, name);
  file = fopen(path, "rb");
  if (file == NULL) exit(1);
  size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  for (i = 0; broken && i + 44 < size; ++i)
    if (memcmp(bytes + i, "IDAT", 4) == 0) {
      bytes[i + 40] ^= 1;
      break;
    }
  file = fopen(name, "wb");
  if (file == NULL) exit(1);
  CHECK(fwrite(bytes, 1, size, file) == size);
  fclose(file);
}

/* A model whose first image cannot be decoded is drawn. */
static void testNotes(skitter_device* device) {
  skitter_crowd* crowd;
  skitter_renderer* renderer = NULL;
  const char* note = NULL;
  copyAsset("piebald.glb", 1);
  copyAsset("piebald.rig.json", 0);
  crowd = makeCrowdOf("{\"herds\": [{\"agents\": 1, \"rig\": \"piebald.glb\"}]}", device, NULL);
  remove("piebald.glb");
  remove("piebald.rig.json");
  NEED(skitter_renderer_create(crowd, pictureWidth, pictureHeight, NULL, &renderer));
  OK(skitter_renderer_note(renderer, 0, &note));
  CHECK(note != NULL && strstr(note, "images[0]: corrupt PNG: ") != NULL);
  OK(skitter_renderer_note(renderer, 1, &note));
  CHECK(note == NULL);
  OK(skitter_renderer_destroy(renderer));
  OK(skitter_crowd_destroy(crowd));
}

static void testPictures(void) {
  host h = makeHost();
  skitter_device* device = adopt(&h);
  skitter_crowd* crowd = makeCrowdOf(standing, device, NULL);
  skitter_crowd_options bare = {0};
  skitter_scene* scene = NULL;
  skitter_renderer *renderer = NULL, *fine = NULL;
  skitter_renderer_options options = {0.1f, 0, 1, 0};
  skitter_view view = {{0}, {0}, 0}, up;
  VkImage image = VK_NULL_HANDLE;
  const char* note = "";
  static uint8_t pixels[pictureBytes], again[pictureBytes];
  int painted = 0, i;

  NEED(skitter_scene_parse(standing, NULL, &scene));
  REFUSED(skitter_scene_view(scene, crowd, 0, NULL), "view is NULL");
  OK(skitter_scene_view(scene, crowd, 0, &view));
  CHECK(fabs(view.field_of_view - 0.8) < 1e-6 && view.eye[1] > view.target[1]);
  OK(skitter_scene_destroy(scene));

  REFUSED(skitter_renderer_create(crowd, 0, 5, NULL, &renderer), "a picture of 0 x 5 pixels");
  REFUSED(skitter_renderer_create(crowd, 5, 5, NULL, NULL), "renderer is NULL");
  REFUSED(skitter_renderer_create(crowd, 5, 5, &options, &renderer), "detail is 0.1, expected 0.25 to 100000");
  options.detail = 0;
  options.scale = 1.5f;
  REFUSED(skitter_renderer_create(crowd, 5, 5, &options, &renderer), "scale is 1.5, expected 0.25 to 1");
  options.detail = 100000;
  options.scale = 0.5f;
  options.occlusion = 1;
  CHECK(skitter_renderer_create(crowd, 1u << 30, 5, NULL, &renderer) == SKITTER_ERROR_DEVICE);
  bare.no_poses = 1;
  {
    skitter_crowd* plain = makeCrowdOf(standing, device, &bare);
    REFUSED(skitter_renderer_create(plain, 5, 5, NULL, &renderer), "pose");
    OK(skitter_crowd_destroy(plain));
  }
  CHECK(renderer == NULL);
  NEED(skitter_renderer_create(crowd, pictureWidth, pictureHeight, NULL, &renderer));
  NEED(skitter_renderer_create(crowd, pictureWidth, pictureHeight, &options, &fine));
  /* It keeps the crowd. */
  OK(skitter_crowd_destroy(crowd));
  REFUSED(skitter_renderer_pixels(renderer, pixels, pictureBytes), "no picture");
  testRefusedViews(renderer, &view);
  OK(skitter_renderer_draw(renderer, &view));
  REFUSED(skitter_renderer_pixels(renderer, pixels, pictureBytes - 1), "rgba has room for");
  REFUSED(skitter_renderer_pixels(renderer, NULL, pictureBytes), "rgba is NULL");
  OK(skitter_renderer_pixels(renderer, pixels, pictureBytes));
  /* The same again, and something else from elsewhere. */
  OK(skitter_renderer_draw(renderer, &view));
  OK(skitter_renderer_pixels(renderer, again, pictureBytes));
  CHECK(memcmp(pixels, again, sizeof pixels) == 0);
  OK(skitter_renderer_draw(fine, &view));
  OK(skitter_renderer_pixels(fine, again, pictureBytes));
  CHECK(memcmp(pixels, again, sizeof pixels) != 0);
  OK(skitter_renderer_destroy(fine));
  up = view;
  up.target[1] = up.eye[1] + 10;
  OK(skitter_renderer_draw(renderer, &up));
  OK(skitter_renderer_pixels(renderer, again, pictureBytes));
  CHECK(memcmp(pixels, again, sizeof pixels) != 0);

  /* Into a command buffer of ours, and over it. */
  begin(&h);
  REFUSED(skitter_renderer_record(renderer, NULL, &view, NULL, NULL), "commands is NULL");
  REFUSED(skitter_renderer_record(renderer, h.commands, NULL, NULL, NULL), "view is NULL");
  OK(skitter_renderer_record(renderer, h.commands, &view, NULL, NULL));
  submit(&h);
  OK(skitter_renderer_pixels(renderer, again, pictureBytes));
  CHECK(memcmp(pixels, again, sizeof pixels) == 0);
  begin(&h);
  OK(skitter_renderer_record(renderer, h.commands, &view, paintRed, &painted));
  submit(&h);
  OK(skitter_renderer_pixels(renderer, again, pictureBytes));
  CHECK(painted == 1);
  for (i = 0; i < pictureBytes; i += 4) CHECK(again[i] == 255 && again[i + 1] == 0 && again[i + 2] == 0);
  OK(skitter_renderer_image(renderer, &image));
  CHECK(image != VK_NULL_HANDLE);
  /* Its spiders have no images. */
  REFUSED(skitter_renderer_note(renderer, 0, NULL), "note is NULL");
  OK(skitter_renderer_note(renderer, 0, &note));
  CHECK(note == NULL);
  testPng(pixels);
  OK(skitter_renderer_destroy(renderer));
  testNotes(device);
  OK(skitter_device_destroy(device));
  closeHost(&h);
}

/* A crowd that walks, with a camera so far above it that it ticks in every eighth tick. */
static void testLevels(void) {
  static const char* const walking =
      "{\"terrain\": {\"columns\": 65, \"rows\": 65, \"amplitude\": 0}, \"herds\": [{\"agents\": 16}]}";
  skitter_device* device = openDevice();
  skitter_crowd_options options = {0};
  skitter_levels levels = {{0}, {0}};
  skitter_level_figures figures[4];
  static const float away[3] = {0, 500, 0}, nowhere[3] = {NAN, 0, 0};
  skitter_crowd* crowd = makeCrowdOf(walking, device, NULL);
  skitter_scene* scene = NULL;
  size_t count = 9;

  OK(skitter_crowd_levels(crowd, figures, 4, &count));
  CHECK(count == 0);
  OK(skitter_crowd_destroy(crowd));

  REFUSED(skitter_levels_load(NULL, &levels), "file_or_default is NULL");
  REFUSED(skitter_levels_load("default", NULL), "levels is NULL");
  REFUSED(skitter_levels_load("/none.json", &levels), "/none.json");
  OK(skitter_levels_load("default", &levels));
  CHECK(levels.distances[0] == 20 && levels.distances[2] == 180 && levels.most[0] == 1000);
  options.levels = &levels;
  levels.distances[1] = 10;
  NEED(skitter_scene_parse(walking, NULL, &scene));
  REFUSED(skitter_crowd_create(device, scene, &options, &crowd), "distances[1] is 10, expected 20 to 8000");
  OK(skitter_scene_destroy(scene));
  levels.distances[1] = 60;
  crowd = makeCrowdOf(walking, device, &options);
  OK(skitter_crowd_step(crowd, 8, dt));
  OK(skitter_crowd_levels(crowd, figures, 4, &count));
  CHECK(count == 4 && figures[0].rate == 1 && figures[3].rate == 8);
  CHECK(figures[0].agents == 16 && figures[0].agent_ticks == 8 * 16);
  REFUSED(skitter_crowd_look_from(NULL, away), "crowd is NULL");
  REFUSED(skitter_crowd_look_from(crowd, NULL), "camera is NULL");
  REFUSED(skitter_crowd_look_from(crowd, nowhere), "camera");
  OK(skitter_crowd_look_from(crowd, away));
  OK(skitter_crowd_step(crowd, 800, dt));
  OK(skitter_crowd_levels(crowd, figures, 4, &count));
  CHECK(figures[0].agents == 0 && figures[3].agents == 16);
  CHECK(figures[3].agent_ticks >= 16 * 90 && figures[3].slip >= 0 && figures[3].slip < 0.05);
  REFUSED(skitter_crowd_levels(crowd, figures, 4, NULL), "count is NULL");
  OK(skitter_crowd_levels(crowd, NULL, 0, &count));
  CHECK(count == 4);
  OK(skitter_crowd_destroy(crowd));
  OK(skitter_device_destroy(device));
}

static void testIk(void) {
  host h = makeHost();
  skitter_device* device = adopt(&h);
  skitter_ik_batch* batch = NULL;
  skitter_ik_bone bones[3];
  skitter_ik_options options = {0};
  skitter_ik_report reports[2];
  float joints[2 * 4 * 3];
  const float targets[] = {1.2f, 0.8f, 0, 0, 5, 0};
  int i;

  memset(bones, 0, sizeof bones);
  for (i = 0; i < 3; ++i) {
    bones[i].length = 1;
    bones[i].direction[0] = 1;
  }
  bones[1].limit_kind = SKITTER_IK_CONE;
  bones[1].limit[0] = 1;
  bones[2].limit_kind = SKITTER_IK_HINGE;
  bones[2].axis[2] = 1;
  bones[2].limit[0] = -2;
  bones[2].limit[1] = 2;

  REFUSED(skitter_ik_batch_create(device, NULL, 3, 2, NULL, &batch), "bones is NULL");
  REFUSED(skitter_ik_batch_create(device, bones, 3, 2, NULL, NULL), "batch is NULL");
  REFUSED(skitter_ik_batch_create(device, bones, 16, 2, NULL, &batch), "bone_count is 16");
  options.solver = "magic";
  REFUSED(skitter_ik_batch_create(device, bones, 3, 2, &options, &batch), "options->solver is \"magic\"");
  options.solver = "active-set";
  NEED(skitter_ik_batch_create(device, bones, 3, 2, &options, &batch));
  REFUSED(skitter_ik_batch_set_targets(batch, targets, 1), "1 targets, expected 2");
  REFUSED(skitter_ik_batch_set_targets(batch, NULL, 2), "xyz is NULL");
  OK(skitter_ik_batch_set_targets(batch, targets, 2));
  OK(skitter_ik_batch_solve(batch));
  REFUSED(skitter_ik_batch_joints(batch, joints, 7), "room for 7, expected 8");
  OK(skitter_ik_batch_joints(batch, joints, 8));
  REFUSED(skitter_ik_batch_reports(batch, reports, 1), "room for 1, expected 2");
  OK(skitter_ik_batch_reports(batch, reports, 2));
  for (i = 0; i < 3; ++i) {
    CHECK(joints[i] == 0);                              /* the base */
    CHECK(fabs(joints[9 + i] - targets[i]) < 3 * 1e-3); /* the tip */
  }
  CHECK(reports[0].stop == SKITTER_IK_TOLERANCE && reports[0].error < 1e-3 && reports[0].iterations > 0);
  CHECK(reports[1].stop == SKITTER_IK_UNREACHABLE || reports[1].error > 0.5);
  OK(skitter_ik_batch_destroy(batch));

  /* The same into a command buffer of ours. */
  {
    float again[2 * 4 * 3];
    NEED(skitter_ik_batch_create(device, bones, 3, 2, &options, &batch));
    OK(skitter_ik_batch_set_targets(batch, targets, 2));
    begin(&h);
    OK(skitter_ik_batch_record(batch, h.commands));
    submit(&h);
    OK(skitter_ik_batch_joints(batch, again, 8));
    CHECK(memcmp(joints, again, sizeof joints) == 0);
    OK(skitter_ik_batch_destroy(batch));
  }
  bones[0].length = -1;
  REFUSED(skitter_ik_batch_create(device, bones, 3, 2, NULL, &batch), "length");
  OK(skitter_device_destroy(device));
  closeHost(&h);
}

static void checkMotion(const skitter_spline_motion* motion, float x, skitter_spline_state state) {
  CHECK(fabs(motion->position[0] - x) < 1e-4 && fabs(motion->travelled - x) < 1e-4);
  CHECK(motion->position[1] == 0 && motion->position[2] == 0);
  CHECK(motion->state == state);
}

/* Along two lines, of which the second is twice as long. */
static void testSplines(void) {
  host h = makeHost();
  skitter_device* device = adopt(&h);
  skitter_spline_batch* batch = NULL;
  skitter_spline_options options = {0};
  skitter_spline_clock clocks[2] = {{0, 3, 1}, {1, 3, 1}};
  skitter_spline_motion motions[2], recorded[2];
  const float points[2 * 4 * 3] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 0, 0, 0, 2, 0, 0, 4, 0, 0, 6, 0, 0};
  const float knots[4] = {0, 0.5f, 2.5f, 3};
  float tangents[2 * 4 * 3] = {0}, lengths[2] = {0};

  options.points = 4;
  options.constant_speed = 1;
  REFUSED(skitter_spline_batch_create(device, 2, NULL, &batch), "options is NULL");
  options.rule = "magic";
  REFUSED(skitter_spline_batch_create(device, 2, &options, &batch),
          "options->rule is \"magic\", expected one of given, catmullRom");
  options.rule = NULL;
  options.points = 1;
  REFUSED(skitter_spline_batch_create(device, 2, &options, &batch), "a spline of 1 points, expected 2 to");
  options.points = 4;
  NEED(skitter_spline_batch_create(device, 2, &options, &batch));
  REFUSED(skitter_spline_batch_set_points(batch, points, 7, NULL, 0), "given 7 points, expected 8");
  REFUSED(skitter_spline_batch_set_points(batch, NULL, 8, NULL, 0), "xyz is NULL");
  REFUSED(skitter_spline_batch_set_points(batch, points, 8, NULL, 4), "knots is NULL");
  REFUSED(skitter_spline_batch_set_points(batch, points, 8, points, 4), "knot 1 is 0 after 0");
  REFUSED(skitter_spline_batch_set_tangents(batch, tangents, NULL, 8), "makes them by rule");
  OK(skitter_spline_batch_set_points(batch, points, 8, NULL, 0));
  REFUSED(skitter_spline_batch_set_clocks(batch, clocks, 1), "given 1 clocks, expected 2");
  clocks[1].duration = 0;
  REFUSED(skitter_spline_batch_set_clocks(batch, clocks, 2), "spline 1: its duration is 0");
  clocks[1].duration = 3;
  OK(skitter_spline_batch_set_clocks(batch, clocks, 2));
  OK(skitter_spline_batch_lengths(batch, lengths, 2));
  CHECK(fabs(lengths[0] - 3) < 1e-4 && fabs(lengths[1] - 6) < 1e-4);
  REFUSED(skitter_spline_batch_lengths(batch, lengths, 1), "room for 1, expected 2");

  OK(skitter_spline_batch_travel(batch, 1.5));
  REFUSED(skitter_spline_batch_motions(batch, motions, 1), "room for 1, expected 2");
  OK(skitter_spline_batch_motions(batch, motions, 2));
  checkMotion(&motions[0], 1.5f, SKITTER_SPLINE_MOVING);
  checkMotion(&motions[1], 1, SKITTER_SPLINE_MOVING);
  CHECK(fabs(motions[0].velocity[0] - 1) < 1e-3 && fabs(motions[1].velocity[0] - 2) < 1e-3);
  OK(skitter_spline_batch_travel(batch, 0.5));
  begin(&h);
  REFUSED(skitter_spline_batch_record(batch, NULL, 1.5), "commands is NULL");
  OK(skitter_spline_batch_record(batch, h.commands, 1.5));
  submit(&h);
  OK(skitter_spline_batch_motions(batch, recorded, 2));
  CHECK(memcmp(motions, recorded, sizeof motions) == 0);
  OK(skitter_spline_batch_travel(batch, 3.5));
  OK(skitter_spline_batch_motions(batch, motions, 2));
  checkMotion(&motions[0], 3, SKITTER_SPLINE_FINISHED);
  checkMotion(&motions[1], 5, SKITTER_SPLINE_MOVING);
  clocks[0].active = 0;
  OK(skitter_spline_batch_set_clocks(batch, clocks, 2));
  OK(skitter_spline_batch_travel(batch, 3.5));
  OK(skitter_spline_batch_motions(batch, motions, 2));
  checkMotion(&motions[0], 0, SKITTER_SPLINE_IDLE);
  OK(skitter_spline_batch_destroy(batch));

  /* By their knots, and to a halt at each point. */
  options.constant_speed = 0;
  options.rule = "given";
  NEED(skitter_spline_batch_create(device, 2, &options, &batch));
  OK(skitter_spline_batch_set_points(batch, points, 8, knots, 4));
  OK(skitter_spline_batch_set_tangents(batch, tangents, NULL, 8));
  clocks[0].active = 1;
  OK(skitter_spline_batch_set_clocks(batch, clocks, 2));
  OK(skitter_spline_batch_travel(batch, 0.5));
  OK(skitter_spline_batch_motions(batch, motions, 2));
  checkMotion(&motions[0], 1, SKITTER_SPLINE_MOVING);
  CHECK(fabs(motions[0].velocity[0]) < 1e-3);
  checkMotion(&motions[1], 0, SKITTER_SPLINE_IDLE);
  tangents[3] = 1; /* the second point of the first one */
  OK(skitter_spline_batch_set_tangents(batch, tangents, tangents, 8));
  OK(skitter_spline_batch_travel(batch, 0.5));
  OK(skitter_spline_batch_motions(batch, motions, 2));
  CHECK(fabs(motions[0].velocity[0] - 1) < 1e-3);
  OK(skitter_spline_batch_destroy(batch));

  OK(skitter_device_destroy(device));
  closeHost(&h);
}

int main(int argc, char** argv) {
  static const struct {
    const char* name;
    void (*run)(void);
  } tests[] = {{"errors", testErrors},   {"scene", testScene},       {"crowd", testCrowd},
               {"sizes", testSizes},     {"steering", testSteering}, {"legs", testLegs},
               {"herds", testHerds},     {"state", testState},       {"adoption", testAdoption},
               {"ground", testGround},   {"records", testRecords},   {"readback", testReadback},
               {"drawing", testDrawing}, {"pictures", testPictures}, {"ik", testIk},
               {"splines", testSplines}, {"levels", testLevels},
               {"ways", testWays}};
  size_t i;
  for (i = 0; argc == 2 && i < COUNT(tests); ++i) {
    if (strcmp(argv[1], tests[i].name) != 0) continue;
    tests[i].run();
    return failures > 0;
  }
  printf("c_test: expected the name of a test\n");
  return 2;
}
