/* What all test programs share. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "halfshade.h"

#define CHECK(condition)                                                                            \
    do {                                                                                            \
        if (!(condition)) {                                                                         \
            char sentence_[512];                                                                    \
            hs_last_error(NULL, sentence_, sizeof sentence_);                                       \
            fprintf(stderr, "%s:%d: %s (last error: %s)\n", __FILE__, __LINE__, #condition, sentence_); \
            exit(1);                                                                                \
        }                                                                                           \
    } while (0)
#define OK(call) CHECK((call) == HS_OK)

/* A structure with its head filled and all else zero. */
#define HEAD(structure, name, kind) structure name = {.type = (kind), .size = sizeof(structure)}

/* A floor of 4 x 4 and a plate above it. */
static const float CORNERS[] = {-2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2, -0.5f, 1, -0.5f, 0.5f, 1, -0.5f, 0.5f, 1, 0.5f, -0.5f, 1, 0.5f};
static const uint32_t INDICES[] = {0, 2, 1, 0, 3, 2, 4, 6, 5, 4, 7, 6};

static inline hs_scene *make_scene(hs_context *context) {
    hs_scene *scene = NULL;
    HEAD(hs_scene_info, info, HS_TYPE_SCENE_INFO);
    info.positions = CORNERS;
    info.vertex_count = 8;
    info.indices = INDICES;
    info.triangle_count = 4;
    OK(hs_scene_create(context, &info, &scene));
    return scene;
}

/* A shot of that scene under a square light, 2 * half wide. */
static inline hs_shot *make_shot(hs_context *context, uint32_t side, double half) {
    hs_scene *scene = make_scene(context);
    hs_shot *shot = NULL;
    HEAD(hs_camera, camera, HS_TYPE_CAMERA);
    HEAD(hs_light, light, HS_TYPE_LIGHT);
    HEAD(hs_settings, settings, HS_TYPE_SETTINGS);
    OK(hs_shot_create(scene, &shot));
    hs_scene_destroy(scene);
    camera.eye[1] = 5;
    camera.eye[2] = 3;
    camera.up[1] = 1;
    camera.vfov_deg = 40;
    camera.width = camera.height = side;
    OK(hs_shot_set_camera(shot, &camera));
    light.center[1] = 3;
    light.u[0] = half;
    light.v[2] = half;
    light.color[0] = light.color[1] = light.color[2] = 1;
    light.intensity = -1;
    OK(hs_shot_set_lights(shot, &light, 1));
    OK(hs_settings_default(HS_TECHNIQUE_PACKET_CONTOUR, &settings));
    settings.split = 1;
    settings.map = 64;
    OK(hs_shot_set_settings(shot, &settings));
    return shot;
}

static inline hs_context *make_context(uint32_t flags) {
    hs_context *context = NULL;
    HEAD(hs_context_info, info, HS_TYPE_CONTEXT_INFO);
    info.flags = flags;
    OK(hs_context_create(&info, &context));
    return context;
}

#endif
