/*
 * Skitter for C99: crowds of legged creatures on uneven ground, animated by Vulkan compute shaders, and
 * inverse kinematics and splines by themselves. docs/c.md shows a program.
 *
 * - Every function returns a skitter_result, but for skitter_version() and skitter_last_error(). No exception
 * leaves one. After an error nothing has changed, unless the function says otherwise.
 * - Pointers must not be NULL where nothing else is said: that is SKITTER_ERROR_INPUT.
 * - Handles are opaque. Each is made by a function whose last argument is the handle, and ended by its
 * ..._destroy, for which NULL is nothing to do. A device lives until all that was made on it has been
 * destroyed as well, and so does a crowd.
 * - Lengths are metres, times seconds, angles radians. The world is right-handed, +Y is up, and an unturned
 * creature faces +Z.
 * - Herds and agents are numbered from 0; agents within their herd.
 * - Functions of one device, and of what was made on it, are called by one thread at a time. Each thread has
 * its own last error message.
 */
#ifndef SKITTER_H
#define SKITTER_H

#include <skitter/records.h>
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
/* This thread's last error message, in one line; empty before the first. It lasts until the next error. */
SKITTER_C const char* skitter_last_error(void);

/* ---- Devices ---- */

typedef struct skitter_device skitter_device;

typedef struct skitter_device_info {
  char name[256];
  char type[16];     /* "discrete", "integrated", "virtual", "cpu", "other" */
  char why_not[512]; /* why a device is not chosen */
  uint32_t index;    /* what skitter_device_create takes, as text */
  int suitable;      /* Skitter runs on it */
  int chosen;        /* skitter_device_create takes it where none is named */
} skitter_device_info;

/* Every device of this machine. Writes up to `room` of them to `infos`, which may be NULL where `room` is 0,
 * and to `count` how many there are. */
SKITTER_C skitter_result skitter_device_list(skitter_device_info* infos, uint32_t room, uint32_t* count);

/* `name`: an index, or part of a name in any case; NULL: the best suitable device. */
SKITTER_C skitter_result skitter_device_create(const char* name, skitter_device** device);

/* Switches on features in a chain, before vkCreateDevice: those that the engine needs, and those that make it
 * faster and that the device has. The chain has VkPhysicalDeviceVulkan12Features and
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
/* Levels of rate (docs/levels.md): who is far from the camera ticks in every second, fourth or eighth tick.
 */
typedef struct skitter_levels {
  float distances[3]; /* metres from the camera to which full, half and quarter rate reach */
  uint32_t most[3];   /* agents that may have full, half and quarter rate */
} skitter_levels;
/* "default", or a JSON file. */
SKITTER_C skitter_result skitter_levels_load(const char* file_or_default, skitter_levels* levels);

typedef struct skitter_crowd_options {
  int no_poses;   /* without bones: no joints, and pictures of herds alone that play clips as they are */
  int no_figures; /* without fidelity figures */
  uint32_t watch_every; /* figures of one agent in this many at a time; 0: of all up to 256, of one in 64 of
                           more */
  uint32_t footfalls;   /* keep so many touchdowns per tick and page (docs/architecture.md#words); 0: none */
  int sleep;            /* agents that have stood still for seconds are passed over */
  const skitter_levels* levels; /* NULL: those of the scene, if it has any */
} skitter_crowd_options;

/* A crowd as it was between two ticks, with all that it needs to go on (docs/state.md). */
typedef struct skitter_state skitter_state;

/* The scene's herds on its terrain. The scene may be destroyed afterwards. `options` may be NULL. */
SKITTER_C skitter_result skitter_crowd_create(skitter_device* device, const skitter_scene* scene,
                                              const skitter_crowd_options* options, skitter_crowd** crowd);
/* The crowd of a state, which goes on as if it had never stopped. The state may be destroyed afterwards.
 * `options`: NULL: those of the crowd that was saved; else poses, footfalls and sleep are as they say, levels
 * are those of the crowd that was saved where they say none, and figures stay as they were. */
SKITTER_C skitter_result skitter_crowd_resume(skitter_device* device, const skitter_state* state,
                                              const skitter_crowd_options* options, skitter_crowd** crowd);

/* Records one tick of `dt` seconds into the caller's command buffer, outside a render pass. The tick waits
 * for earlier reads of the crowd's buffers, and makes its results visible to vertex, fragment, compute and
 * transfer work after it. Each recorded tick is submitted once, in order. A crowd keeps the dt of its first
 * tick. What the scene's events have for that time happens first. A tick before which a herd comes or goes
 * takes the queue's lock, submits and waits: it is recorded when all ticks before it are submitted. The
 * buffers of a herd that goes are freed; what was recorded of them before must not be submitted any more.
 * After SKITTER_ERROR_INPUT none of the tick's events has happened. After SKITTER_ERROR_DEVICE, where memory
 * does not suffice for a herd that comes, the events before it have, and the tick, recorded again, goes on
 * with it. */
SKITTER_C skitter_result skitter_crowd_record(skitter_crowd* crowd, VkCommandBuffer commands, float dt);
/* Makes so many ticks on the device's queue and waits for the last one. After an error the ticks before the
 * one that failed are made, and skitter_crowd_tick() tells how many; of its events have happened those that
 * skitter_crowd_record() says. */
SKITTER_C skitter_result skitter_crowd_step(skitter_crowd* crowd, uint64_t ticks, float dt);

/* Where the camera is from the next tick on, world metres. Rates depend on it where there are levels of them,
 * and nothing else does. Before the first call everybody has full rate. */
SKITTER_C skitter_result skitter_crowd_look_from(skitter_crowd* crowd, const float camera[3]);
/* What became of a level. */
typedef struct skitter_level_figures {
  uint32_t rate;        /* its agents tick in every so many-th tick */
  uint64_t agents;      /* that have it after the last tick */
  uint64_t agent_ticks; /* that were made at it, since the crowd was made */
  double slip; /* mean slide of a planted foot per stance, leg lengths; NaN without a stance or figures */
} skitter_level_figures;
/* One of each level, full rate first; none without levels. Writes up to `room` of them, and to `count` how
 * many there are. Waits for the device. */
SKITTER_C skitter_result skitter_crowd_levels(const skitter_crowd* crowd, skitter_level_figures* levels,
                                              size_t room, size_t* count);

/* Ticks recorded so far. */
SKITTER_C skitter_result skitter_crowd_tick(const skitter_crowd* crowd, uint64_t* tick);
/* Numbers of herds, those of herds that are gone among them: herds are 0 to `herds` - 1. */
SKITTER_C skitter_result skitter_crowd_herds(const skitter_crowd* crowd, uint32_t* herds);
/* Agents that are there, of all herds and of one. */
SKITTER_C skitter_result skitter_crowd_agent_count(const skitter_crowd* crowd, uint64_t* agents);
SKITTER_C skitter_result skitter_crowd_herd_agents(const skitter_crowd* crowd, uint32_t herd,
                                                   uint32_t* agents);
/* Places of one herd, which are its agents and its reserve; its legs; and the bones of its longest leg. */
SKITTER_C skitter_result skitter_crowd_herd_places(const skitter_crowd* crowd, uint32_t herd,
                                                   uint32_t* places);
SKITTER_C skitter_result skitter_crowd_herd_legs(const skitter_crowd* crowd, uint32_t herd, uint32_t* legs);
SKITTER_C skitter_result skitter_crowd_herd_bones(const skitter_crowd* crowd, uint32_t herd, uint32_t* bones);
/* Writes how large the creature of each place of the herd is, times its rig, to `sizes`, which has room for
 * `room` of them. A herd whose scene has `sizes` numbers its places size after size. */
SKITTER_C skitter_result skitter_crowd_sizes(const skitter_crowd* crowd, uint32_t herd, float* sizes,
                                             size_t room);

/* Replaces a rectangle of the ground's samples before the next tick: `columns` from column `x` and `rows`
 * from row `z` on, row after row, metres above mid height, the mean of the lowest and the highest sample as
 * made. Feet whose ground moves step anew. */
SKITTER_C skitter_result skitter_crowd_edit_heights(skitter_crowd* crowd, uint32_t x, uint32_t z,
                                                    uint32_t columns, uint32_t rows, const float* heights);

/* The ground: samples at the corners of a regular grid, bilinear in between. Columns run to +x and rows to
 * +z; the grid is centred on the world's origin. */
typedef struct skitter_terrain {
  uint32_t columns, rows;
  float spacing_x, spacing_z; /* metres per sample */
} skitter_terrain;
SKITTER_C skitter_result skitter_crowd_terrain(const skitter_crowd* crowd, skitter_terrain* terrain);
/* Writes its samples as edited, row after row, metres above that mid height, to `heights`, which has room
 * for `room` of them. */
SKITTER_C skitter_result skitter_crowd_heights(const skitter_crowd* crowd, float* heights, size_t room);
/* Height and unit normal of the ground, as edited, at x, z in world metres. Beyond its edge it goes on as at
 * the edge. `height` or `normal` may be NULL. */
SKITTER_C skitter_result skitter_crowd_ground(const skitter_crowd* crowd, float x, float z, float* height,
                                              float normal[3]);

/* The functions below wait for the device. */

/* Writes where bodies are, x, y, z of each place of the herd in world metres, to `xyz`, which has room for
 * `room` of them. Too little room is an error, and nothing is written. Where nobody is, y is -1,000,000. */
SKITTER_C skitter_result skitter_crowd_positions(const skitter_crowd* crowd, uint32_t herd, double* xyz,
                                                 size_t room);
/* Writes headings about +Y, one per place: 0 faces +Z, a quarter turn +X. */
SKITTER_C skitter_result skitter_crowd_headings(const skitter_crowd* crowd, uint32_t herd, float* radians,
                                                size_t room);
/* Writes x, y, z of joints in world metres: for each place and leg the starts of its bones and the foot,
 * bones + 1 per leg. NaN fills up legs with fewer bones. There is room for `room` joints. */
SKITTER_C skitter_result skitter_crowd_joints(const skitter_crowd* crowd, uint32_t herd, double* xyz,
                                              size_t room);

/* A hash of all records that the next tick depends on: equal for equal device, scene, seed and ticks. */
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
#define SKITTER_ALL_HERDS UINT32_MAX
/* The figures of one herd, or of SKITTER_ALL_HERDS. */
SKITTER_C skitter_result skitter_crowd_fidelity(const skitter_crowd* crowd, uint32_t herd,
                                                skitter_fidelity* fidelity);

typedef struct skitter_footfall {
  uint64_t tick;
  uint32_t agent, leg;
  float place[3]; /* position of the foot, world metres */
  float speed;    /* of the foot over the tick that ended there, m/s */
} skitter_footfall;
/* The touchdowns of the last tick, by agent and leg. Writes up to `room` of them to `footfalls`, which may be
 * NULL where `room` is 0, and to `count` how many there are. A crowd that was made without footfalls has
 * none. */
SKITTER_C skitter_result skitter_crowd_footfalls(const skitter_crowd* crowd, uint32_t herd,
                                                 skitter_footfall* footfalls, size_t room, size_t* count);

typedef struct skitter_picked {
  uint32_t herd, agent;
  double distance; /* metres, from the ray's start to the agent's sphere; from the point to its middle */
  double place[3]; /* position where the ray meets the sphere; the sphere's middle */
} skitter_picked;
/* The nearest agent under a ray, which is `length` metres long (INFINITY: without an end) and has a direction
 * of any length but 0; and the agent nearest to a point. An agent is picked by a sphere about the middle of
 * its body. World metres. `found` becomes 0, and `picked` stays as it is, where there is none. */
SKITTER_C skitter_result skitter_crowd_pick(const skitter_crowd* crowd, const double start[3],
                                            const double direction[3], double length, skitter_picked* picked,
                                            int* found);
SKITTER_C skitter_result skitter_crowd_nearest(const skitter_crowd* crowd, const double point[3],
                                               skitter_picked* picked, int* found);

SKITTER_C skitter_result skitter_crowd_destroy(skitter_crowd* crowd);

/* ---- Steering ---- */

/* These functions take effect in the crowd's next tick (docs/steering.md). The caller's data may go at once,
 * and the last of several calls for one agent counts. A number out of its range, a count that is not the
 * herd's and an agent that is not there are SKITTER_ERROR_INPUT; then nothing is changed. */

typedef enum skitter_goal_kind {
  SKITTER_GOAL_CROSS = 0,    /* to the far side of the ground and back, for ever */
  SKITTER_GOAL_POINT = 1,    /* to `target`, to stand there */
  SKITTER_GOAL_NONE = 2,     /* nowhere */
  SKITTER_GOAL_VELOCITY = 3, /* by `velocity` */
  /* Only of herds with ways (docs/ways.md): */
  SKITTER_GOAL_ROUTE = 4,  /* from one of `places` to the next, once or in a loop */
  SKITTER_GOAL_ROAM = 5,   /* from place to place within `radius` of `target`, for ever */
  SKITTER_GOAL_FOLLOW = 6, /* to where a herd or one of its agents is */
  SKITTER_GOAL_FLEE = 7    /* out of threats and obstacles */
} skitter_goal_kind;
typedef struct skitter_goal {
  skitter_goal_kind kind;
  float target[2];      /* x, z, metres, of kinds POINT and ROAM */
  float speed;          /* metres per second, 0 to 1000, of all kinds but NONE and VELOCITY */
  float velocity[2];    /* x, z, metres per second, at most 1000 long, of kind VELOCITY */
  const float* places;  /* x, z of each, metres, of kind ROUTE */
  uint32_t place_count; /* 1 to 16 */
  int loop;             /* of kind ROUTE: whether the first place follows the last one */
  float radius;         /* metres, 0.01 to 4096, of kind ROAM */
  uint32_t herd;        /* of kind FOLLOW */
  int follow_agent;     /* 0: to the middle of that herd */
  uint32_t agent;       /* else to the agent in this place of it */
} skitter_goal;

/* A position and a heading: where an agent is put, its feet on the ground around. */
typedef struct skitter_place {
  float x, z;    /* metres, on the ground */
  float heading; /* radians about +Y, 0 faces +Z; -1000 to 1000 */
} skitter_place;

/* A handle of an agent: its herd, its place there, and how often agents have come to that place. It never
 * means another agent, not even once its place is taken again. */
typedef uint64_t skitter_agent_id;
#define SKITTER_NO_AGENT UINT64_MAX
/* The handle of the agent in that place of the herd; where nobody is, SKITTER_ERROR_INPUT. */
SKITTER_C skitter_result skitter_crowd_agent_id(const skitter_crowd* crowd, uint32_t herd, uint32_t agent,
                                                skitter_agent_id* id);
/* The handles of all, one per place; SKITTER_NO_AGENT where nobody is. There is room for `room` of them. */
SKITTER_C skitter_result skitter_crowd_agent_ids(const skitter_crowd* crowd, uint32_t herd,
                                                 skitter_agent_id* ids, size_t room);
/* `has` becomes whether that agent is there. */
SKITTER_C skitter_result skitter_crowd_has(const skitter_crowd* crowd, skitter_agent_id agent, int* has);

/* Goals: one for all agents of a herd; one per place of a herd; one per agent for `count` of any herds. */
SKITTER_C skitter_result skitter_crowd_steer(skitter_crowd* crowd, uint32_t herd, const skitter_goal* goal);
SKITTER_C skitter_result skitter_crowd_steer_each(skitter_crowd* crowd, uint32_t herd,
                                                  const skitter_goal* goals, size_t count);
SKITTER_C skitter_result skitter_crowd_steer_agents(skitter_crowd* crowd, const skitter_agent_id* agents,
                                                    const skitter_goal* goals, size_t count);
/* Likewise, the speed alone: metres per second, 0 to 1000. A velocity is cut to it until the next goal. */
SKITTER_C skitter_result skitter_crowd_set_speed(skitter_crowd* crowd, uint32_t herd, float speed);
SKITTER_C skitter_result skitter_crowd_set_speed_each(skitter_crowd* crowd, uint32_t herd,
                                                      const float* speeds, size_t count);
SKITTER_C skitter_result skitter_crowd_set_speed_agents(skitter_crowd* crowd, const skitter_agent_id* agents,
                                                        const float* speeds, size_t count);
/* Puts agents elsewhere. They stand, and nothing of their earlier motion is kept. Goals stay. */
SKITTER_C skitter_result skitter_crowd_teleport(skitter_crowd* crowd, const skitter_agent_id* agents,
                                                const skitter_place* places, size_t count);

/* Pushes agents of herds with reactions (docs/reactions.md): changes of velocity x, z, m/s, two numbers per
 * agent, each at most 100 m/s long. Several of one agent before a tick add up. */
SKITTER_C skitter_result skitter_crowd_push(skitter_crowd* crowd, const skitter_agent_id* agents,
                                            const float* velocities, size_t count);
typedef enum skitter_reaction_phase {
  SKITTER_REACTION_STEADY = 0,
  SKITTER_REACTION_STUMBLING = 1,
  SKITTER_REACTION_FALLING = 2,
  SKITTER_REACTION_LYING = 3,
  SKITTER_REACTION_RIGHTING = 4,
  SKITTER_REACTION_RISING = 5
} skitter_reaction_phase;
typedef struct skitter_reaction {
  skitter_reaction_phase phase;
  uint32_t falls, stands;  /* since the agent came: how often it fell, and stood again */
  float down, down_before; /* seconds since this fall began, and of those before it */
} skitter_reaction;
/* What the last tick left, one of each place of the herd; steady where it has no reactions. Waits for the
 * device. There is room for `room` of them. */
SKITTER_C skitter_result skitter_crowd_reactions(const skitter_crowd* crowd, uint32_t herd,
                                                 skitter_reaction* reactions, size_t room);

/* How agents of a herd that adapts get on (docs/evolve.md). */
typedef enum skitter_search_phase {
  SKITTER_SEARCH_AT_EASE = 0,
  SKITTER_SEARCH_SEARCHING = 1,
  SKITTER_SEARCH_SETTLED = 2
} skitter_search_phase;
typedef struct skitter_search {
  skitter_search_phase phase;
  uint32_t trials; /* that have ended since the agent was hurt last */
  float best;      /* the highest fitness of these */
} skitter_search;
/* What the last tick left, one of each place of the herd; at ease where it does not adapt. Waits for the
 * device. There is room for `room` of them. */
SKITTER_C skitter_result skitter_crowd_searches(const skitter_crowd* crowd, uint32_t herd,
                                                skitter_search* searches, size_t room);

/* Adds an agent to a herd with a reserve, in its lowest empty place, which says how large it is, and removes
 * one from such a herd. `goal`: NULL: the herd's. `id` may be NULL. No empty place and no reserve are
 * SKITTER_ERROR_INPUT. */
SKITTER_C skitter_result skitter_crowd_add(skitter_crowd* crowd, uint32_t herd, const skitter_place* place,
                                           const skitter_goal* goal, skitter_agent_id* id);
SKITTER_C skitter_result skitter_crowd_remove(skitter_crowd* crowd, skitter_agent_id agent);

/* `agents` becomes how many agents of a herd with ways have a goal that no way leads to: they stop at the
 * nearest place that one leads to (docs/ways.md). Waits for the device. */
SKITTER_C skitter_result skitter_crowd_cannot_reach(const skitter_crowd* crowd, uint32_t herd,
                                                    uint32_t* agents);

/* Legs that are hurt, and heal, of herds whose scene says "hurt": true (docs/damage.md). */
typedef enum skitter_leg_state {
  SKITTER_LEG_WHOLE = 0,
  SKITTER_LEG_LAME = 1,  /* its steps take longer, and the body goes slower */
  SKITTER_LEG_STUCK = 2, /* holds its pose, and does not carry */
  SKITTER_LEG_LOST = 3   /* ends at one of its joints, and does not carry */
} skitter_leg_state;
/* As `bone`: the first one is left as a stump; of a leg with only one, nothing is. */
#define SKITTER_STUMP UINT32_MAX
typedef struct skitter_agent_leg {
  skitter_agent_id agent;
  uint32_t leg; /* by its number in the rig, from 0 on */
  skitter_leg_state state;
  uint32_t bone; /* of a lost leg: the first one that is lost, counted from the root */
} skitter_agent_leg;
/* The other legs regroup in the next tick. A herd that cannot be hurt, and a leg or a bone that the rig
 * lacks, are SKITTER_ERROR_INPUT. heal: all legs of the agent are whole. `state`: as was said last. */
SKITTER_C skitter_result skitter_crowd_hurt(skitter_crowd* crowd, const skitter_agent_leg* legs,
                                            size_t count);
SKITTER_C skitter_result skitter_crowd_heal(skitter_crowd* crowd, skitter_agent_id agent);
SKITTER_C skitter_result skitter_crowd_leg_state(const skitter_crowd* crowd, skitter_agent_id agent,
                                                 uint32_t leg, skitter_leg_state* state);

/* What agents of such herds carry (docs/loads.md): from the next tick on, in place of what they carried.
 * `load`: as was said last, of mass 0 where the agent carries nothing. */
typedef struct skitter_load {
  float mass;      /* times the agent's own, 0 to 4; 0: it carries nothing */
  float offset[3]; /* of the load's centre from the body's: left, up and forward, -2 to 2 leg lengths */
} skitter_load;
typedef struct skitter_agent_load {
  skitter_agent_id agent;
  skitter_load load;
} skitter_agent_load;
SKITTER_C skitter_result skitter_crowd_carry(skitter_crowd* crowd, const skitter_agent_load* loads,
                                             size_t count);
SKITTER_C skitter_result skitter_crowd_carried(const skitter_crowd* crowd, skitter_agent_id agent,
                                               skitter_load* load);

/* A threat of that number, 0 to 63, comes, moves or, with radius 0, goes: a disc about x, z, metres, that
 * agents of herds with ways keep off (docs/ways.md). */
SKITTER_C skitter_result skitter_crowd_set_threat(skitter_crowd* crowd, uint32_t number,
                                                  const float centre[2], float radius);

/* A handle of a herd: its number, and which one it is of those that have had that number. */
typedef struct skitter_herd_id {
  uint32_t herd, generation;
} skitter_herd_id;
/* Adds a herd of a scene, under the lowest number that no herd has, and removes one, between two ticks. Both
 * make or free device memory at once, submit and wait; adding takes about 0.3 s per size. Before a herd is
 * removed, what was recorded has been submitted, and the readbacks and palettes that read it are destroyed.
 * No command buffer that was recorded before may be submitted afterwards. `id` may be NULL. */
SKITTER_C skitter_result skitter_crowd_add_herd(skitter_crowd* crowd, const skitter_scene* scene,
                                                uint32_t herd, skitter_herd_id* id);
SKITTER_C skitter_result skitter_crowd_remove_herd(skitter_crowd* crowd, skitter_herd_id herd);
SKITTER_C skitter_result skitter_crowd_herd_id(const skitter_crowd* crowd, uint32_t herd,
                                               skitter_herd_id* id);
SKITTER_C skitter_result skitter_crowd_has_herd(const skitter_crowd* crowd, skitter_herd_id herd, int* has);

/* ---- Records ---- */

/* Everything that the stages exchange, as arrays of vec4 on the device (docs/reading.md). The layouts are in
 * skitter/records.h, which C99 can include. An `origin` is a point in world metres that positions are
 * relative to; NULL: the world's. */

/* SKITTER_RECORD_GOAL, SKITTER_RECORD_BODY and so on: the table at the end of skitter/records.h, where the
 * layouts are, too. SKITTER_RECORD_WATCH is neither handed out nor downloaded. */
typedef enum skitter_record {
#define SKITTER_RECORD_NAMED(NAME, name, binding, per, stride, kept, spawned, hashed) SKITTER_RECORD_##NAME,
  SKITTER_RECORDS(SKITTER_RECORD_NAMED)
#undef SKITTER_RECORD_NAMED
} skitter_record;

/* A herd's records in one page. The buffer is the crowd's and stays the same as long as it has the herd;
 * usage STORAGE_BUFFER, TRANSFER_SRC, TRANSFER_DST. Equal herds share pages, so other herds' records may lie
 * before and after. skitter_crowd_record() waits for vertex, fragment, compute and transfer work recorded
 * before it, and makes the records visible to such work after it: reads need no barrier of the caller's. */
typedef struct skitter_record_buffer {
  VkBuffer buffer;
  VkDeviceSize offset, bytes;   /* of what holds the herd's records, and of legs perhaps other herds' too */
  uint32_t first_agent, agents; /* of the herd, in this page */
  uint32_t first;               /* first_agent's index in the page */
  uint32_t stride;              /* vec4 per record */
  uint32_t legs;                /* of an agent, for leg records; 0: the records are one per agent */
} skitter_record_buffer;
/* One per page of the herd; does not wait. Writes up to `room` of them to `buffers`, which may be NULL where
 * `room` is 0, and to `count` how many there are: 0 where the herd keeps no such records. */
SKITTER_C skitter_result skitter_crowd_buffers(const skitter_crowd* crowd, uint32_t herd,
                                               skitter_record record, skitter_record_buffer* buffers,
                                               size_t room, size_t* count);
/* The index of the vec4 in the buffer with which a record begins. The agent is of the herd and in this page;
 * `leg` is 0 where records are one per agent. */
SKITTER_C skitter_result skitter_record_at(const skitter_record_buffer* buffer, uint32_t agent, uint32_t leg,
                                           uint32_t* at);

/* The touchdowns of the last tick on the device: 2 vec4 each, min(count, room) of them in any order. Equal
 * herds share buffers, and events number agents through all of them. */
typedef struct skitter_footfall_buffer {
  VkBuffer events;
  VkBuffer counters;            /* holds count, a uint32 */
  uint32_t count_offset;        /* bytes */
  uint32_t room;                /* events */
  uint32_t first_agent, agents; /* the herd's, of those that events number */
  uint32_t first_of_herd;       /* the number in the herd of first_agent */
} skitter_footfall_buffer;
/* As skitter_crowd_buffers(). Their room is 0 in a crowd that was made without footfalls. */
SKITTER_C skitter_result skitter_crowd_footfall_buffers(const skitter_crowd* crowd, uint32_t herd,
                                                        skitter_footfall_buffer* buffers, size_t room,
                                                        size_t* count);

/* Goals on the device, for shaders of the caller's, which may write them (docs/steering.md): that of agent
 * first_agent + i begins with vec4 2 * (first + i). */
typedef struct skitter_goal_buffer {
  VkBuffer goals;
  uint32_t first;               /* record of first_agent */
  uint32_t first_agent, agents; /* of the herd */
} skitter_goal_buffer;
SKITTER_C skitter_result skitter_crowd_goal_buffers(const skitter_crowd* crowd, uint32_t herd,
                                                    skitter_goal_buffer* buffers, size_t room, size_t* count);

/* Writes a herd's records of one name, place after place and within an agent leg after leg, to `numbers`,
 * which has room for `room` floats, and to `count` how many they are. Too little room is an error, but no
 * room (then `numbers` may be NULL) asks for the count alone. Waits for the device. */
SKITTER_C skitter_result skitter_crowd_records(const skitter_crowd* crowd, uint32_t herd,
                                               skitter_record record, float* numbers, size_t room,
                                               size_t* count);

/* Records as numbers with a meaning, of a download, of a readback or of the caller's own copy. */

typedef struct skitter_body {
  double position[3]; /* on the ground below the body; exact to 1e-6 m, wherever it is */
  float rotation[4];  /* world from model, quaternion x, y, z, w */
  float heading[2];   /* x, z, unit */
  float velocity[3];  /* metres per second, horizontal */
  float turn_rate;    /* radians per second */
  int present;        /* 0: nobody is in this place of the herd */
} skitter_body;
SKITTER_C skitter_result skitter_decode_body(const float record[16], const double* origin,
                                             skitter_body* body);

/* How a leg goes from where it left the ground to where it lands, of adaptive herds. */
typedef struct skitter_step {
  double lift_off[3], landing[3];
  float first_tick, ticks;
  int last_resort; /* nothing better was found to land on */
} skitter_step;
/* `body`: the record of the leg's agent, after the same tick. */
SKITTER_C skitter_result skitter_decode_step(const float record[8], const float body[16],
                                             const double* origin, skitter_step* step);

/* Where a foot should be, and where it is. `body` is the agent's, whose origin they have. */
typedef struct skitter_foot {
  double place[3];
  float progress; /* of its step; 1: planted */
} skitter_foot;
typedef struct skitter_tip {
  double place[3];
  float error; /* metres from where it should be */
} skitter_tip;
SKITTER_C skitter_result skitter_decode_foot(const float record[4], const skitter_body* body,
                                             skitter_foot* foot);
SKITTER_C skitter_result skitter_decode_tip(const float record[4], const skitter_body* body,
                                            skitter_tip* tip);

/* A bone of a pose record of `floats` numbers: entry 0 is the body, 1 + leg * bones + bone a leg's bone,
 * where the longest leg has so many bones. A vertex v of it is at position + rotation (v - rest start),
 * relative to the body's position along world axes. */
typedef struct skitter_bone {
  float rotation[4]; /* quaternion x, y, z, w */
  float position[3]; /* of the joint at its start */
} skitter_bone;
SKITTER_C skitter_result skitter_decode_bone(const float* pose, size_t floats, uint32_t entry,
                                             skitter_bone* bone);
/* A joint of a pose record of the controllers clip and planted: the rows of the 3x4 matrix that takes a
 * vertex of the clips' skin to world axes about the body's position. */
SKITTER_C skitter_result skitter_decode_joint(const float* pose, size_t floats, uint32_t joint,
                                              float rows[12]);

/* An event of a footfall buffer. `of_herd` becomes 0, and `footfall` stays as it is, where it is of another
 * herd than the buffer was asked for. */
SKITTER_C skitter_result skitter_decode_footfall(const float event[8], const skitter_footfall_buffer* buffer,
                                                 skitter_footfall* footfall, int* of_herd);

/* ---- Readback ---- */

/* Where agents are, some ticks late and without waiting: a ring of copies, which the device makes after a
 * tick. Once a herd that it reads is removed, it records no more: that is SKITTER_ERROR_INPUT. What was
 * recorded into the caller's command buffers has finished before it is destroyed. */
typedef struct skitter_readback skitter_readback;

/* All zero: the defaults. */
typedef struct skitter_readback_options {
  const uint32_t* herds; /* whose agents are read */
  uint32_t herd_count;   /* 0: all herds that are there now; herds that come later read as empty */
  uint32_t slots;        /* copies that there is room for, at least 2; 0: 3. 64 bytes per place each */
} skitter_readback_options;

/* `options` may be NULL. */
SKITTER_C skitter_result skitter_readback_create(skitter_crowd* crowd,
                                                 const skitter_readback_options* options,
                                                 skitter_readback** readback);
/* Records a copy after skitter_crowd_record() in the same command buffer, outside a render pass. Each is
 * submitted once, in order. Nothing is recorded, and the tick is counted as skipped, where every slot is
 * still on its way. */
SKITTER_C skitter_result skitter_readback_record(skitter_readback* readback, VkCommandBuffer commands);
/* Makes so many ticks on the device's queue, with a copy after the last one, and does not wait for them, but
 * where two ticks are still on their way. An error leaves what one of skitter_crowd_step() does; where a herd
 * that is read was removed, all of the ticks are made, without a copy. */
SKITTER_C skitter_result skitter_readback_step(skitter_readback* readback, uint64_t ticks, float dt);
SKITTER_C skitter_result skitter_readback_skipped(const skitter_readback* readback, uint64_t* skipped);

/* Takes the newest copy that has been made, of the crowd after `tick`. `found` becomes 0, and `tick` stays as
 * it is, where there is none yet. The functions below read what was taken last; it is gone with the next
 * ..._record() or ..._step(), and until something is taken again they are SKITTER_ERROR_INPUT. */
SKITTER_C skitter_result skitter_readback_take(skitter_readback* readback, uint64_t* tick, int* found);

/* Places of the herd; 0 for a herd that is not read. */
SKITTER_C skitter_result skitter_readback_places(const skitter_readback* readback, uint32_t herd,
                                                 uint32_t* places);
/* As skitter_crowd_positions(), relative to an origin; NULL: the world's. */
SKITTER_C skitter_result skitter_readback_positions(const skitter_readback* readback, uint32_t herd,
                                                    const double* origin, double* xyz, size_t room);
/* Body records where they lie, 16 floats per place, for skitter_decode_body(). They are there as long as what
 * was taken. */
SKITTER_C skitter_result skitter_readback_bodies(const skitter_readback* readback, uint32_t herd,
                                                 const float** records);
/* Holds the herd's agents in whatever pose they are. `found` becomes 0, and the rest stays as it is, where
 * there are none. */
SKITTER_C skitter_result skitter_readback_bounds(const skitter_readback* readback, uint32_t herd,
                                                 const double* origin, double least[3], double most[3],
                                                 int* found);
/* As skitter_crowd_pick() and skitter_crowd_nearest(), of the agents that were read. */
SKITTER_C skitter_result skitter_readback_pick(const skitter_readback* readback, const double start[3],
                                               const double direction[3], double length,
                                               skitter_picked* picked, int* found);
SKITTER_C skitter_result skitter_readback_nearest(const skitter_readback* readback, const double point[3],
                                                  skitter_picked* picked, int* found);
/* Waits for the ticks that skitter_readback_step() and skitter_crowd_step() made. */
SKITTER_C skitter_result skitter_readback_destroy(skitter_readback* readback);

/* ---- Drawing by yourself ---- */

/* Where the host's axes point, as seen by a creature in Skitter's own. */
typedef enum skitter_axes {
  SKITTER_AXES_RIGHT_Y_UP = 0, /* x, y, z: faces +Z, its left is +X: glTF, OpenGL, Godot */
  SKITTER_AXES_LEFT_Y_UP = 1,  /* -x, y, z: faces +Z, its left is -X: Unity */
  SKITTER_AXES_RIGHT_Z_UP = 2, /* x, -z, y: faces -Y, its left is +X: Blender */
  SKITTER_AXES_LEFT_Z_UP = 3   /* z, -x, y: faces +X, its left is -Y: Unreal */
} skitter_axes;
/* All zero: Skitter's own. */
typedef struct skitter_space {
  skitter_axes axes;
  float metres_per_unit; /* 0.01: the host counts centimetres; 0: 1 */
} skitter_space;

typedef enum skitter_transform_format {
  SKITTER_TRANSFORM_MATRIX = 0,    /* 12 floats: the rows of a 3x4 matrix */
  SKITTER_TRANSFORM_QUATERNION = 1 /* 8 floats: rotation x, y, z, w; translation x, y, z; scale */
} skitter_transform_format;

/* Where transforms are written: a range of a buffer of the caller's, with usage STORAGE_BUFFER. Transforms
 * follow each other agent by agent and, of palettes, entry by entry. What is between and beyond them stays as
 * it is. */
typedef struct skitter_transform_range {
  VkBuffer buffer;     /* VK_NULL_HANDLE: these transforms are not written */
  VkDeviceSize offset; /* bytes, a multiple of 16 */
  VkDeviceSize bytes;  /* that may be written */
  skitter_transform_format format;
  VkDeviceSize stride; /* bytes from one transform to the next, a multiple of 16; 0: no gap */
  int planar;          /* an array for each vec4 of the transforms, one after the other; with stride 0 */
} skitter_transform_range;

/* The transforms that one frame of the caller's reads: one per agent, from the model space of the mesh at
 * rest to the host's space; and for each agent as many as skitter_crowd_palette_entries() says, for the bones
 * of skitter_skin_vertex. */
typedef struct skitter_palette_target {
  skitter_transform_range instances, palettes;
} skitter_palette_target;

/* All zero: the defaults. */
typedef struct skitter_palette_options {
  skitter_space space;
  int relative; /* palettes lead to the mesh's model space, and the agent's instance transform comes after */
} skitter_palette_options;

/* Writes a herd's transforms into buffers of the caller's, on the device, after a tick. A vertex is then at
 * the sum of weight[i] * palette[bone[i]] * vertex. An agent that is not there has transforms of zeros. The
 * buffers outlive it, the herd must not be removed while it is there, and what was recorded has finished
 * before it is destroyed. */
typedef struct skitter_palettes skitter_palettes;

SKITTER_C skitter_result skitter_crowd_palette_entries(const skitter_crowd* crowd, uint32_t herd,
                                                       uint32_t* entries);
/* A target for each frame that may be in flight. `options` may be NULL. Palettes need a crowd with poses, and
 * matrices where the controller is clip or planted. */
SKITTER_C skitter_result skitter_palettes_create(skitter_crowd* crowd, uint32_t herd,
                                                 const skitter_palette_target* targets, uint32_t target_count,
                                                 const skitter_palette_options* options,
                                                 skitter_palettes** palettes);
/* Records the writes of one target, after skitter_crowd_record() in the same or an earlier submission,
 * outside a render pass, with barriers against vertex, fragment, compute and transfer work before and after
 * them. `origin` is the point of the world that the host's space has its own origin in; NULL: the world's. */
SKITTER_C skitter_result skitter_palettes_record(const skitter_palettes* palettes, VkCommandBuffer commands,
                                                 const double* origin, uint32_t target);
SKITTER_C skitter_result skitter_palettes_destroy(skitter_palettes* palettes);

/* The mesh that the transforms move: at rest, in model space, at the first of the herd's sizes. It is a copy,
 * which needs no crowd. */
typedef struct skitter_skin_mesh skitter_skin_mesh;

typedef struct skitter_skin_vertex {
  float position[3];
  float normal[3];
  float colour[3];   /* linear RGB: the model's vertex colours times its materials' base colours */
  uint16_t bones[4]; /* entries of an agent's palette */
  float weights[4];  /* they sum to 1 */
} skitter_skin_vertex;
typedef struct skitter_skin_level {
  uint32_t first_index, index_count;
  float pixels; /* it serves where the mesh's radius covers at least so many pixels; 0 of the last one */
} skitter_skin_level;

/* `space`: that of the palettes; NULL: Skitter's own. Takes a while: levels are simplified here. */
SKITTER_C skitter_result skitter_skin_mesh_create(const skitter_crowd* crowd, uint32_t herd,
                                                  const skitter_space* space, skitter_skin_mesh** mesh);
/* Vertices of all levels; triangles, three indices into the vertices each, counter-clockwise as seen from
 * outside; levels, finest first. Each writes up to `room` of them, and to `count` how many there are. The
 * list may be NULL where `room` is 0. */
SKITTER_C skitter_result skitter_skin_mesh_vertices(const skitter_skin_mesh* mesh,
                                                    skitter_skin_vertex* vertices, size_t room,
                                                    size_t* count);
SKITTER_C skitter_result skitter_skin_mesh_indices(const skitter_skin_mesh* mesh, uint32_t* indices,
                                                   size_t room, size_t* count);
SKITTER_C skitter_result skitter_skin_mesh_levels(const skitter_skin_mesh* mesh, skitter_skin_level* levels,
                                                  size_t room, size_t* count);
/* The radius of a sphere about an agent's position that holds every pose, at the largest size, in the host's
 * unit. */
SKITTER_C skitter_result skitter_skin_mesh_radius(const skitter_skin_mesh* mesh, float* radius);
SKITTER_C skitter_result skitter_skin_mesh_destroy(skitter_skin_mesh* mesh);

/* ---- Pictures ---- */

/* Where a picture is taken from. World metres; the projection is reversed-Z with an infinite far plane. */
typedef struct skitter_view {
  float eye[3];
  float target[3];     /* elsewhere than the eye */
  float field_of_view; /* radians, vertical, above 0 and below pi; 0: 0.8 */
} skitter_view;
/* The camera of a scene at a time, any number of seconds. Only the scene's camera is read: herds that came or
 * went need no change of it. */
SKITTER_C skitter_result skitter_scene_view(const skitter_scene* scene, const skitter_crowd* crowd,
                                            double seconds, skitter_view* view);

/* Draws a crowd and its ground into an image of its own. It needs a crowd with poses, and a queue with
 * graphics. What was recorded has finished before it is destroyed. */
typedef struct skitter_renderer skitter_renderer;

/* All zero: the defaults. */
typedef struct skitter_renderer_options {
  float detail; /* agents are drawn as finely as if they were so many times larger, 0.25 to 100000; 0: 1. Less
                   is cheaper. */
  float scale;  /* pixels that are shaded along each side, of those that the picture has, 0.25 to 1; 0: 1 */
  int footprints; /* not 0: feet of adaptive herds leave prints on the ground */
  int occlusion;  /* above 0: agents whom others or the ground hide are left out, which changes no picture;
                     below 0: they are not; 0: where it pays */
} skitter_renderer_options;
/* `options`: NULL: the defaults. */
SKITTER_C skitter_result skitter_renderer_create(skitter_crowd* crowd, uint32_t width, uint32_t height,
                                                 const skitter_renderer_options* options,
                                                 skitter_renderer** renderer);
/* Draws the crowd as it is on the device's queue, and waits. */
SKITTER_C skitter_result skitter_renderer_draw(skitter_renderer* renderer, const skitter_view* view);
/* Records a picture into the caller's command buffer, after the crowd's tick in the same or an earlier
 * submission. `over`, or NULL, draws on top of it: it is called within dynamic rendering into one colour
 * attachment of VK_FORMAT_R8G8B8A8_SRGB and the picture's size, without depth, one sample a pixel. */
SKITTER_C skitter_result skitter_renderer_record(skitter_renderer* renderer, VkCommandBuffer commands,
                                                 const skitter_view* view,
                                                 void (*over)(VkCommandBuffer commands, void* user),
                                                 void* user);
/* The image of the last picture, VK_FORMAT_R8G8B8A8_SRGB in TRANSFER_SRC_OPTIMAL; the renderer's own. */
SKITTER_C skitter_result skitter_renderer_image(const skitter_renderer* renderer, VkImage* image);
/* The last picture that was drawn or, once submitted, recorded: RGBA8 sRGB, rows without gaps, top row first,
 * to `rgba`, which has room for `room` bytes. Waits for the device. */
SKITTER_C skitter_result skitter_renderer_pixels(const skitter_renderer* renderer, uint8_t* rgba,
                                                 size_t room);
/* Which image of the crowd's models cannot be decoded, and why: the index-th of them, from 0 on, or NULL
 * behind the last. Its material is drawn in a flat colour. It lives until the next picture. */
SKITTER_C skitter_result skitter_renderer_note(const skitter_renderer* renderer, size_t index,
                                               const char** note);
SKITTER_C skitter_result skitter_renderer_destroy(skitter_renderer* renderer);

/* Writes such pixels, 4 bytes each, as an opaque PNG. The file takes its name once it is whole. */
SKITTER_C skitter_result skitter_write_png(const char* file, uint32_t width, uint32_t height,
                                           const uint8_t* rgba);

/* ---- States ---- */

/* Saving waits for the device. What was recorded must have been submitted. `note` is JSON of the caller's
 * own, which comes back with the state, or NULL. */

/* The file takes its name once it is whole; until then an older one stays. */
SKITTER_C skitter_result skitter_crowd_save(const skitter_crowd* crowd, const char* file, const char* note);
/* Writes a state to `bytes`, which has room for `room` of them, and to `size` how many it has. Too little
 * room is an error, but no room (then `bytes` may be NULL) asks for the size alone. */
SKITTER_C skitter_result skitter_crowd_save_to_memory(const skitter_crowd* crowd, const char* note,
                                                      void* bytes, size_t room, size_t* size);

/* A state in a file, and one in memory, which is copied. While the state is there, its file may be replaced
 * but not be changed in place. Damage is SKITTER_ERROR_INPUT here or in skitter_crowd_resume(). */
SKITTER_C skitter_result skitter_state_load(const char* file, skitter_state** state);
SKITTER_C skitter_result skitter_state_parse(const void* bytes, size_t size, skitter_state** state);
/* The last tick that was made, and the seconds per tick, 0 before the first. */
SKITTER_C skitter_result skitter_state_tick(const skitter_state* state, uint64_t* tick);
SKITTER_C skitter_result skitter_state_dt(const skitter_state* state, float* dt);
/* The note with which the state was saved, as JSON; empty without one. It lives as long as the state. */
SKITTER_C skitter_result skitter_state_note(const skitter_state* state, const char** note);
/* A copy of the scene, with the herds that were there, also those that had come. */
SKITTER_C skitter_result skitter_state_scene(const skitter_state* state, skitter_scene** scene);
SKITTER_C skitter_result skitter_state_destroy(skitter_state* state);

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
/* Writes x, y, z of the joints, bone_count + 1 per chain, base first. There is room for `room` joints. */
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
/* One per chain. */
SKITTER_C skitter_result skitter_ik_batch_reports(const skitter_ik_batch* batch, skitter_ik_report* reports,
                                                  size_t room);
SKITTER_C skitter_result skitter_ik_batch_destroy(skitter_ik_batch* batch);

/* ---- Splines ---- */

/* Many cubic Hermite splines of one kind, along which something travels (docs/spline.md). Lengths are in the
 * caller's unit, knots and clocks in seconds or any unit of time. */
typedef struct skitter_spline_batch skitter_spline_batch;

/* All zero but for the points: the defaults. */
typedef struct skitter_spline_options {
  uint32_t points;  /* a spline, 2 to 1024 */
  int closed;       /* splines come back to their first points */
  const char* rule; /* of the tangents, a name of docs/spline.md, such as "monotone"; NULL: "catmullRom" */
  float tension, continuity, bias; /* of the rules "cardinal" and "kochanekBartels" */
  int constant_speed;              /* the arc length grows evenly, not the knots' time */
} skitter_spline_options;

SKITTER_C skitter_result skitter_spline_batch_create(skitter_device* device, uint32_t splines,
                                                     const skitter_spline_options* options,
                                                     skitter_spline_batch** batch);
/* x, y, z of `points` points, spline after spline, within +-1e6; and when they are met: as many knots as a
 * spline has points, and one more of a closed one, for all splines or of each. Knots ascend by at least 1e-6;
 * NULL and a count of 0: 0, 1, 2, ... These and the functions below, but for ..._record(), wait for the
 * device. */
SKITTER_C skitter_result skitter_spline_batch_set_points(skitter_spline_batch* batch, const float* xyz,
                                                         size_t points, const float* knots,
                                                         size_t knot_count);
/* Velocities with which each point is met and left, for the rule "given" alone. `leaving`: NULL: as they are
 * met. */
SKITTER_C skitter_result skitter_spline_batch_set_tangents(skitter_spline_batch* batch, const float* arriving,
                                                           const float* leaving, size_t points);

typedef struct skitter_spline_clock {
  double start;
  double duration; /* of the way, or of a round; above 0 */
  int active;
} skitter_spline_clock;
/* One per spline. */
SKITTER_C skitter_result skitter_spline_batch_set_clocks(skitter_spline_batch* batch,
                                                         const skitter_spline_clock* clocks, size_t splines);

/* Computes where everything is at a time, and waits. */
SKITTER_C skitter_result skitter_spline_batch_travel(skitter_spline_batch* batch, double now);
/* Records the same into the caller's command buffer, outside a render pass, with barriers against compute and
 * transfer work before and after it. */
SKITTER_C skitter_result skitter_spline_batch_record(skitter_spline_batch* batch, VkCommandBuffer commands,
                                                     double now);

typedef enum skitter_spline_state {
  SKITTER_SPLINE_IDLE = 0, /* not active, or not yet begun: at the start */
  SKITTER_SPLINE_MOVING = 1,
  SKITTER_SPLINE_FINISHED = 2, /* at the end; a closed spline never is */
  SKITTER_SPLINE_REFUSED = 3   /* its length is beyond 1e18 */
} skitter_spline_state;
typedef struct skitter_spline_motion {
  float position[3];
  float velocity[3]; /* a second of the clock */
  float travelled;   /* arc length since the start; of a closed spline of all rounds */
  skitter_spline_state state;
} skitter_spline_motion;
/* One per spline, of the last time. */
SKITTER_C skitter_result skitter_spline_batch_motions(const skitter_spline_batch* batch,
                                                      skitter_spline_motion* motions, size_t room);
/* Arc lengths, one per spline. */
SKITTER_C skitter_result skitter_spline_batch_lengths(const skitter_spline_batch* batch, float* lengths,
                                                      size_t room);
SKITTER_C skitter_result skitter_spline_batch_destroy(skitter_spline_batch* batch);

#ifdef __cplusplus
}
#endif

#endif
