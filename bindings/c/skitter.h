/*
 * Skitter for C99: crowds of legged creatures on uneven ground, animated by Vulkan compute shaders, and
 * inverse kinematics by themselves. docs/c.md shows a program.
 *
 * - Every function returns a skitter_result, but for skitter_version() and skitter_last_error(). No exception
 * leaves one. After an error nothing has changed, unless the function says otherwise.
 * - Pointers must not be NULL where nothing else is said: that is SKITTER_ERROR_INPUT.
 * - Handles are opaque. Each is made by a function whose last argument is the handle, and ended by its
 * ..._destroy, for which NULL is nothing to do. A device lives until all that was made on it has been
 * destroyed as well.
 * - Lengths are metres, times seconds, angles radians. The world is right-handed, +Y is up, and an unturned
 * creature faces +Z.
 * - Herds and agents are numbered from 0; agents within their herd.
 * - Functions of one device, and of what was made on it, are called by one thread at a time. Error messages
 * are by thread.
 */
#ifndef SKITTER_H
#define SKITTER_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

#ifdef __GNUC__
#define SKITTER_C __attribute__((visibility("default")))
#else
#define SKITTER_C
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum skitter_result {
  SKITTER_OK = 0,
  SKITTER_ERROR_INPUT = 2,  /* a wrong argument, an unreadable or malformed file */
  SKITTER_ERROR_DEVICE = 3, /* no usable Vulkan device, not enough of its memory, or it failed */
  SKITTER_ERROR_MEMORY = 4, /* the host has no memory left */
  SKITTER_ERROR_OTHER = 5   /* a fault of Skitter's */
} skitter_result;

/* "0.1.0". */
SKITTER_C const char* skitter_version(void);
/* What the last error of this thread was, in one line; empty before the first. It holds until the next error.
 */
SKITTER_C const char* skitter_last_error(void);

/* ---- Devices ---- */

typedef struct skitter_device skitter_device;

typedef struct skitter_device_info {
  char name[256];
  char type[16];     /* "discrete", "integrated", "virtual", "cpu", "other" */
  char why_not[512]; /* of a device that is not chosen: why */
  uint32_t index;    /* what skitter_device_create takes, as text */
  int suitable;      /* Skitter runs on it */
  int chosen;        /* skitter_device_create takes it where none is named */
} skitter_device_info;

/* Every device of this machine. Writes up to `room` of them to `infos`, which may be NULL where `room` is 0,
 * and to `count` how many there are. */
SKITTER_C skitter_result skitter_device_list(skitter_device_info* infos, uint32_t room, uint32_t* count);

/* `name`: an index, or part of a name in any case; NULL: the best suitable device. */
SKITTER_C skitter_result skitter_device_create(const char* name, skitter_device** device);

/* Switches on in a chain of features, before vkCreateDevice, what the engine needs and, of what makes it
 * quicker, what the device has. The chain has VkPhysicalDeviceVulkan12Features and
 * VkPhysicalDeviceVulkan13Features. */
SKITTER_C skitter_result skitter_add_features(VkPhysicalDeviceFeatures2* chain, VkPhysicalDevice device);

/* A Vulkan device of the caller's, who keeps it and destroys it after all that was made on it here; Vulkan
 * 1.3. docs/embedding.md lists what it needs. What is missing is named in one error. All zero but for the
 * handles, queue family and features: the defaults. */
typedef struct skitter_adoption {
  VkInstance instance;
  VkPhysicalDevice physical_device;
  VkDevice device;
  uint32_t queue_family;
  VkQueue queue;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr; /* NULL: that of the Vulkan loader */
  const VkPhysicalDeviceFeatures2* features;        /* the chain that vkCreateDevice was given */
  const char* const* extensions;                    /* enabled ones, of instance and device; or NULL */
  uint32_t extension_count;
  /* Called about each use of the queue by the engine, both or neither. Without them the caller keeps its own
   * submissions to the queue apart from these functions. */
  void (*lock_queue)(void* user);
  void (*unlock_queue)(void* user);
  void* user;
  VkPipelineCache pipeline_cache; /* or VK_NULL_HANDLE */
} skitter_adoption;
SKITTER_C skitter_result skitter_device_adopt(const skitter_adoption* from, skitter_device** device);

SKITTER_C skitter_result skitter_device_destroy(skitter_device* device);

/* ---- Scenes ---- */

typedef struct skitter_scene skitter_scene;

/* 1,000 spiders that cross generated ground. */
SKITTER_C skitter_result skitter_scene_builtin(skitter_scene** scene);
/* A scene file (docs/scene.md). */
SKITTER_C skitter_result skitter_scene_load(const char* file, skitter_scene** scene);
/* The text of a scene file. File names in it are relative to `folder`; NULL: to the working directory. */
SKITTER_C skitter_result skitter_scene_parse(const char* json, const char* folder, skitter_scene** scene);
SKITTER_C skitter_result skitter_scene_herds(const skitter_scene* scene, uint32_t* herds);
SKITTER_C skitter_result skitter_scene_agents(const skitter_scene* scene, uint32_t herd, uint32_t* agents);
SKITTER_C skitter_result skitter_scene_set_agents(skitter_scene* scene, uint32_t herd, uint32_t agents);
SKITTER_C skitter_result skitter_scene_set_seed(skitter_scene* scene, uint64_t seed);
SKITTER_C skitter_result skitter_scene_destroy(skitter_scene* scene);

/* ---- Crowds ---- */

typedef struct skitter_crowd skitter_crowd;

/* All zero: the defaults. */
typedef struct skitter_crowd_options {
  int no_poses;         /* without bones: neither joints nor pictures */
  int no_figures;       /* without fidelity figures */
  uint32_t watch_every; /* figures of one agent of this many at a time; 0: of all up to 256, of one in 64 of
                           more */
  uint32_t footfalls;   /* keep so many touchdowns of a tick, of each page of records; 0: none */
  int sleep;            /* agents that have stood still for seconds are passed over */
} skitter_crowd_options;

/* The scene's herds on its terrain. The scene may be destroyed afterwards. `options` may be NULL. */
SKITTER_C skitter_result skitter_crowd_create(skitter_device* device, const skitter_scene* scene,
                                              const skitter_crowd_options* options, skitter_crowd** crowd);

/* Records one tick of `dt` seconds into the caller's command buffer, outside a render pass. The tick waits
 * for earlier reads of the crowd's buffers, and makes its results visible to vertex, compute and transfer
 * work after it. Each recorded tick is submitted once, in order. A crowd keeps the dt of its first tick. */
SKITTER_C skitter_result skitter_crowd_record(skitter_crowd* crowd, VkCommandBuffer commands, float dt);
/* Makes so many ticks on the device's queue and waits for the last one. */
SKITTER_C skitter_result skitter_crowd_step(skitter_crowd* crowd, uint64_t ticks, float dt);

/* Ticks recorded so far. */
SKITTER_C skitter_result skitter_crowd_tick(const skitter_crowd* crowd, uint64_t* tick);
SKITTER_C skitter_result skitter_crowd_herds(const skitter_crowd* crowd, uint32_t* herds);
/* Of all herds. */
SKITTER_C skitter_result skitter_crowd_agent_count(const skitter_crowd* crowd, uint64_t* agents);
/* Places of one herd, which are its agents and its reserve; its legs; and the bones of its longest leg. */
SKITTER_C skitter_result skitter_crowd_herd_agents(const skitter_crowd* crowd, uint32_t herd,
                                                   uint32_t* agents);
SKITTER_C skitter_result skitter_crowd_herd_legs(const skitter_crowd* crowd, uint32_t herd, uint32_t* legs);
SKITTER_C skitter_result skitter_crowd_herd_bones(const skitter_crowd* crowd, uint32_t herd, uint32_t* bones);

/* The functions below wait for the device. */

/* Where bodies are: x, y, z of each agent of the herd in world metres, to `xyz`, which has room for `room`
 * agents. Too little room is an error, and nothing is written. */
SKITTER_C skitter_result skitter_crowd_positions(const skitter_crowd* crowd, uint32_t herd, double* xyz,
                                                 size_t room);
/* About +Y: 0 faces +Z, a quarter turn +X. One an agent. */
SKITTER_C skitter_result skitter_crowd_headings(const skitter_crowd* crowd, uint32_t herd, float* radians,
                                                size_t room);
/* x, y, z of joints in world metres: of each agent and leg the starts of its bones and the foot, bones + 1 a
 * leg. NaN fills up legs with fewer bones. There is room for `room` joints. */
SKITTER_C skitter_result skitter_crowd_joints(const skitter_crowd* crowd, uint32_t herd, double* xyz,
                                              size_t room);

/* Of every record that the next tick depends on: the same device, scene, seed and ticks give the same hash.
 */
SKITTER_C skitter_result skitter_crowd_state_hash(const skitter_crowd* crowd, uint64_t* hash);

/* How well agents moved in the ticks in which they were watched (docs/stages/measure.md). Lengths are in leg
 * lengths. A figure without a sample is 0. */
typedef struct skitter_fidelity {
  uint64_t agent_ticks, stances;
  double slip, skating;
  double penetration, penetration_beyond;
  double floating, floating_beyond;
  double segment_penetration, segment_penetration_most;
  double crossing;
  double reach_error_p99, reach_error_most;
  double limit_violation, limit_violations; /* NaN where no herd is judged by limits */
  double foot_jerk, body_jerk;
  double margin, margin_least, unstable;
  uint64_t last_resorts, not_finite;
} skitter_fidelity;
/* Of one herd, or of SKITTER_ALL_HERDS. */
#define SKITTER_ALL_HERDS UINT32_MAX
SKITTER_C skitter_result skitter_crowd_fidelity(const skitter_crowd* crowd, uint32_t herd,
                                                skitter_fidelity* fidelity);

typedef struct skitter_footfall {
  uint64_t tick;
  uint32_t agent, leg;
  float place[3]; /* world metres */
  float speed;    /* of the foot over the tick that ended there, m/s */
} skitter_footfall;
/* The touchdowns of the last tick, by agent and leg. Writes up to `room` of them to `footfalls`, which may be
 * NULL where `room` is 0, and to `count` how many there are. A crowd that was made without footfalls has
 * none. */
SKITTER_C skitter_result skitter_crowd_footfalls(const skitter_crowd* crowd, uint32_t herd,
                                                 skitter_footfall* footfalls, size_t room, size_t* count);

SKITTER_C skitter_result skitter_crowd_destroy(skitter_crowd* crowd);

/* ---- Inverse kinematics ---- */

/* Many chains of one kind, solved at once (docs/ik.md). Each has its base at 0; lengths are in the caller's
 * unit. */
typedef struct skitter_ik_batch skitter_ik_batch;

typedef enum skitter_ik_limit {
  SKITTER_IK_FREE = 0,
  SKITTER_IK_CONE = 1,    /* limit[0]: half-angle, above 0 */
  SKITTER_IK_ELLIPSE = 2, /* limit[0..3]: half-angles toward +x, +y, -x, -y, each above 0 and up to 3.1 */
  SKITTER_IK_HINGE = 3    /* about `axis`, from limit[0] to limit[1], up to 3.1 either way */
} skitter_ik_limit;

typedef struct skitter_ik_bone {
  float length;       /* >= 0; one of 0 never turns */
  float direction[3]; /* at rest, any length but 0 */
  skitter_ik_limit limit_kind;
  float limit[4];             /* radians */
  float axis[3];              /* of a hinge, in the chain's rest axes: any length but 0, not along the bone */
  float twist_min, twist_max; /* about the bone, of balls only, radians */
  float stiffness;            /* of the pull to the rest pose; 0: 1 */
} skitter_ik_bone;

/* All zero: the defaults. */
typedef struct skitter_ik_options {
  const char* solver;  /* a name of docs/ik.md, such as "fabrik"; NULL: what measures best */
  uint32_t iterations; /* at most; 0: 20 for free chains, 64 for limited ones, 4 where solves continue */
  float tolerance;     /* share of the reach; 0: 9e-4 */
  int continues;       /* solves go on from the result of the solve before */
} skitter_ik_options;

/* 1 to 15 bones. `options` may be NULL. */
SKITTER_C skitter_result skitter_ik_batch_create(skitter_device* device, const skitter_ik_bone* bones,
                                                 uint32_t bone_count, uint32_t chains,
                                                 const skitter_ik_options* options, skitter_ik_batch** batch);
/* x, y, z of a target for each chain, relative to its base. `chains` is as the batch has them. */
SKITTER_C skitter_result skitter_ik_batch_set_targets(skitter_ik_batch* batch, const float* xyz,
                                                      size_t chains);
/* Solves every chain and waits. */
SKITTER_C skitter_result skitter_ik_batch_solve(skitter_ik_batch* batch);
/* Records one solve into the caller's command buffer, outside a render pass, with barriers against compute
 * and transfer work before and after it. */
SKITTER_C skitter_result skitter_ik_batch_record(const skitter_ik_batch* batch, VkCommandBuffer commands);
/* x, y, z of the joints, bone_count + 1 a chain, base first. There is room for `room` joints. */
SKITTER_C skitter_result skitter_ik_batch_joints(const skitter_ik_batch* batch, float* xyz, size_t room);

typedef enum skitter_ik_stop {
  SKITTER_IK_TOLERANCE = 0,
  SKITTER_IK_CAP = 1,
  SKITTER_IK_STALL = 2,
  SKITTER_IK_UNREACHABLE = 3,
  SKITTER_IK_SKIPPED = 4
} skitter_ik_stop;
typedef struct skitter_ik_report {
  float error; /* of the tip from its target, share of the reach */
  uint32_t iterations;
  skitter_ik_stop stop;
} skitter_ik_report;
/* One a chain. */
SKITTER_C skitter_result skitter_ik_batch_reports(const skitter_ik_batch* batch, skitter_ik_report* reports,
                                                  size_t room);
SKITTER_C skitter_result skitter_ik_batch_destroy(skitter_ik_batch* batch);

#ifdef __cplusplus
}
#endif

#endif
