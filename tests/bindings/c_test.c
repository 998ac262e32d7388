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
  goals[0].kind = (skitter_goal_kind)4;
  REFUSED(skitter_crowd_steer(crowd, 0, &goals[0]), "goal.kind is 4, expected a skitter_goal_kind");
  OK(skitter_crowd_steer_agents(crowd, NULL, NULL, 0));

  OK(skitter_crowd_steer(crowd, 0, &goal));
  testSpeeds(crowd, ids);

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
  vkDestroyCommandPool(h.device, h.pool, NULL);
  vkDestroyDevice(h.device, NULL);
  vkDestroyInstance(h.instance, NULL);
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
  vkDestroyCommandPool(h.device, h.pool, NULL);
  vkDestroyDevice(h.device, NULL);
  vkDestroyInstance(h.instance, NULL);
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
  vkDestroyCommandPool(h.device, h.pool, NULL);
  vkDestroyDevice(h.device, NULL);
  vkDestroyInstance(h.instance, NULL);
}

int main(int argc, char** argv) {
  static const struct {
    const char* name;
    void (*run)(void);
  } tests[] = {{"errors", testErrors},  {"scene", testScene},       {"crowd", testCrowd},
               {"sizes", testSizes},    {"steering", testSteering}, {"herds", testHerds},
               {"state", testState},    {"adoption", testAdoption}, {"ik", testIk},
               {"splines", testSplines}};
  size_t i;
  for (i = 0; argc == 2 && i < COUNT(tests); ++i) {
    if (strcmp(argv[1], tests[i].name) != 0) continue;
    tests[i].run();
    return failures > 0;
  }
  printf("c_test: expected the name of a test\n");
  return 2;
}
