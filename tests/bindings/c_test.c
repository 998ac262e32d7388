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

static skitter_device* openDevice(void) {
  skitter_device* device = NULL;
  NEED(skitter_device_create(NULL, &device));
  return device;
}

static skitter_crowd* makeCrowd(skitter_device* device, const skitter_crowd_options* options) {
  skitter_scene* scene = NULL;
  skitter_crowd* crowd = NULL;
  NEED(skitter_scene_parse(twoHerds, NULL, &scene));
  NEED(skitter_crowd_create(device, scene, options, &crowd));
  OK(skitter_scene_destroy(scene));
  return crowd;
}

static void testErrors(void) {
  skitter_device* device = NULL;
  skitter_scene* scene = NULL;
  skitter_crowd* crowd = NULL;
  skitter_ik_batch* batch = NULL;
  skitter_device_info info;
  skitter_fidelity fidelity;
  skitter_footfall footfall;
  skitter_adoption nothing;
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
  REFUSED(skitter_crowd_positions(NULL, 0, places, 1), "crowd is NULL");
  REFUSED(skitter_crowd_headings(NULL, 0, numbers, 1), "crowd is NULL");
  REFUSED(skitter_crowd_joints(NULL, 0, places, 1), "crowd is NULL");
  REFUSED(skitter_crowd_state_hash(NULL, &m), "crowd is NULL");
  REFUSED(skitter_crowd_fidelity(NULL, 0, &fidelity), "crowd is NULL");
  REFUSED(skitter_crowd_footfalls(NULL, 0, &footfall, 1, &s), "crowd is NULL");

  REFUSED(skitter_ik_batch_create(NULL, NULL, 1, 1, NULL, &batch), "device is NULL");
  REFUSED(skitter_ik_batch_set_targets(NULL, numbers, 1), "batch is NULL");
  REFUSED(skitter_ik_batch_solve(NULL), "batch is NULL");
  REFUSED(skitter_ik_batch_record(NULL, NULL), "batch is NULL");
  REFUSED(skitter_ik_batch_joints(NULL, numbers, 1), "batch is NULL");
  REFUSED(skitter_ik_batch_reports(NULL, NULL, 1), "batch is NULL");

  OK(skitter_scene_destroy(scene));
  OK(skitter_device_destroy(NULL));
  OK(skitter_scene_destroy(NULL));
  OK(skitter_crowd_destroy(NULL));
  OK(skitter_ik_batch_destroy(NULL));
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
  REFUSED(skitter_crowd_herd_agents(crowd, 2, &inHerd), "herd 2: the crowd has 2");
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

int main(int argc, char** argv) {
  static const struct {
    const char* name;
    void (*run)(void);
  } tests[] = {{"errors", testErrors},
               {"scene", testScene},
               {"crowd", testCrowd},
               {"adoption", testAdoption},
               {"ik", testIk}};
  size_t i;
  for (i = 0; argc == 2 && i < COUNT(tests); ++i) {
    if (strcmp(argv[1], tests[i].name) != 0) continue;
    tests[i].run();
    return failures > 0;
  }
  printf("c_test: expected the name of a test\n");
  return 2;
}
