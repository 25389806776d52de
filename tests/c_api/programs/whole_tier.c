/* Every function of the standalone tier does what it says. */
#include <math.h>

#include "check.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE };

static unsigned messages;

static void count(uint32_t severity, const char *message, void *user) {
    CHECK(*(int *)user == 7);
    if (severity == HS_LOG_WARNING) {
        ++messages;
        fprintf(stderr, "%s\n", message);
    }
}

static void devices(hs_context *context) {
    uint32_t many = 0, i, usable = 0;
    hs_device_info *list;
    hs_context *same = NULL;
    HEAD(hs_device_info, own, HS_TYPE_DEVICE_INFO);
    HEAD(hs_context_info, info, HS_TYPE_CONTEXT_INFO);
    OK(hs_context_device(context, &own));
    CHECK(own.usable == 1 && own.missing[0] == 0 && strlen(own.uuid) == 32);
    OK(hs_devices(NULL, &many));
    CHECK(many > 0);
    list = calloc(many, sizeof *list);
    CHECK(list != NULL);
    for (i = 0; i < many; ++i) {
        list[i].type = HS_TYPE_DEVICE_INFO;
        list[i].size = sizeof *list;
    }
    OK(hs_devices(list, &many));
    for (i = 0; i < many; ++i) usable += list[i].usable;
    CHECK(usable > 0);
    many = 0;
    CHECK(hs_devices(list, &many) == HS_INVALID_ARGUMENT && many > 0);
    free(list);
    info.device = own.uuid;
    OK(hs_context_create(&info, &same));
    hs_context_destroy(same);
    info.device = "no such device";
    CHECK(hs_context_create(&info, &same) == HS_UNSUPPORTED && same == NULL);
}

static void textured_scene(hs_context *context) {
    static const uint8_t RGBA[] = {255, 255, 255, 255, 0, 0, 0, 0};
    static const float UV[] = {0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t SURFACES[] = {0, 0, 1, 1};
    hs_scene *scene = NULL;
    hs_material materials[2];
    HEAD(hs_texture, texture, HS_TYPE_TEXTURE);
    HEAD(hs_scene_info, info, HS_TYPE_SCENE_INFO);
    HEAD(hs_scene_counts, counts, HS_TYPE_SCENE_COUNTS);
    memset(materials, 0, sizeof materials);
    materials[0].type = materials[1].type = HS_TYPE_MATERIAL;
    materials[0].size = materials[1].size = sizeof *materials;
    materials[0].base_color[3] = materials[1].base_color[3] = 1;
    materials[0].texture = HS_NO_TEXTURE;
    materials[1].alpha_cutoff = 0.5f;
    texture.rgba = RGBA;
    texture.width = 2;
    texture.height = 1;
    info.positions = CORNERS;
    info.texcoords = UV;
    info.vertex_count = 8;
    info.indices = INDICES;
    info.triangle_count = 4;
    info.triangle_materials = SURFACES;
    info.materials = materials;
    info.material_count = 2;
    info.textures = &texture;
    info.texture_count = 1;
    info.origin[0] = 1e6;
    OK(hs_scene_create(context, &info, &scene));
    OK(hs_scene_describe(scene, &counts));
    CHECK(counts.vertices == 8 && counts.triangles == 4 && counts.masked_triangles == 2);
    CHECK(counts.lower[0] == 1e6 - 2 && counts.upper[1] == 1 && counts.cameras == 0 && counts.lights == 0);
    hs_scene_destroy(scene);
    materials[1].texture = 1;
    CHECK(hs_scene_create(context, &info, &scene) == HS_INVALID_ARGUMENT && scene == NULL);
}

static double error_against(const float *image, const float *truth) {
    double sum = 0;
    int i, counted = 0;
    for (i = 0; i < PIXELS; ++i) {
        CHECK(isnan(image[i]) == isnan(truth[i]));
        if (!isnan(truth[i])) {
            CHECK(image[i] >= 0 && image[i] <= 1);
            sum += fabs(image[i] - truth[i]);
            ++counted;
        }
    }
    CHECK(counted > PIXELS / 4);
    return sum / counted;
}

static void frames(hs_context *context) {
    static float first[PIXELS], second[PIXELS], truth[PIXELS], facing[PIXELS], error[PIXELS];
    static uint8_t picture[4 * PIXELS];
    hs_shot *shot = make_shot(context, SIDE, 0.4);
    hs_renderer *renderer = NULL;
    uint32_t i;
    double sum = 0;
    HEAD(hs_settings, settings, HS_TYPE_SETTINGS);
    HEAD(hs_renderer_info, info, HS_TYPE_RENDERER_INFO);
    HEAD(hs_statistics, statistics, HS_TYPE_STATISTICS);
    HEAD(hs_pass, pass, HS_TYPE_PASS);
    HEAD(hs_reference_info, reference, HS_TYPE_REFERENCE_INFO);
    OK(hs_settings_default(HS_TECHNIQUE_PACKET_CONTOUR, &settings));
    settings.split = 1;
    settings.map = 64;
    settings.counters = 1;
    OK(hs_shot_set_settings(shot, &settings));
    info.picture = 1;
    info.exposure = 1;
    OK(hs_renderer_create(shot, &info, &renderer));
    CHECK(hs_renderer_statistics(renderer, &statistics) == HS_NOT_READY);
    CHECK(hs_renderer_pass(renderer, 0, &pass) == HS_NOT_READY);
    CHECK(hs_renderer_picture(renderer, picture, sizeof picture) == HS_NOT_READY);
    OK(hs_renderer_render(renderer));
    OK(hs_renderer_visibility(renderer, 0, first, PIXELS));
    OK(hs_renderer_render(renderer));
    OK(hs_renderer_visibility(renderer, 0, second, PIXELS));
    CHECK(memcmp(first, second, sizeof first) == 0);
    CHECK(hs_renderer_visibility(renderer, 1, first, PIXELS) == HS_INVALID_ARGUMENT);
    CHECK(hs_renderer_visibility(renderer, 0, first, PIXELS - 1) == HS_INVALID_ARGUMENT);
    OK(hs_renderer_picture(renderer, picture, sizeof picture));
    for (i = 0; i < PIXELS; ++i) {
        CHECK(picture[4 * i + 3] == 255);
        sum += picture[4 * i];
    }
    CHECK(sum > 0);
    OK(hs_renderer_statistics(renderer, &statistics));
    CHECK(statistics.view_count == 1 && statistics.views_with_casters == 1 && statistics.views_with_receivers == 1);
    CHECK(statistics.pixels == statistics.lit + statistics.umbra + statistics.penumbra && statistics.penumbra > 0);
    CHECK(statistics.memory_bytes > 0 && statistics.nodes_visited > 0);
    sum = 0;
    for (i = 0; i < statistics.pass_count; ++i) {
        OK(hs_renderer_pass(renderer, i, &pass));
        CHECK(pass.name[0] != 0 && pass.count > 0);
        sum += pass.device_ms;
    }
    CHECK(fabs(sum - statistics.device_ms) < 1e-6 * (1 + sum));
    CHECK(hs_renderer_pass(renderer, statistics.pass_count, &pass) == HS_INVALID_ARGUMENT);
    reference.samples = 256;
    OK(hs_reference(shot, &reference, truth, facing, error, PIXELS));
    /* A map of 64 texels over the plate: measured 0.004 on average. */
    CHECK(error_against(second, truth) < 0.01);
    OK(hs_reference(shot, &reference, first, NULL, NULL, PIXELS));
    CHECK(memcmp(first, truth, sizeof first) == 0);
    hs_renderer_destroy(renderer);
    OK(hs_renderer_create(shot, NULL, &renderer));
    OK(hs_renderer_render(renderer));
    CHECK(hs_renderer_picture(renderer, picture, sizeof picture) == HS_UNSUPPORTED);
    hs_renderer_destroy(renderer);
    hs_shot_destroy(shot);
}

static void techniques(hs_context *context) {
    uint32_t technique;
    hs_shot *shot = make_shot(context, 8, 0.4);
    for (technique = HS_TECHNIQUE_PACKET_CONTOUR; technique <= HS_TECHNIQUE_OCCLUDER_DRIVEN; ++technique) {
        HEAD(hs_settings, settings, HS_TYPE_SETTINGS);
        OK(hs_settings_default(technique, &settings));
        CHECK(settings.technique == technique && settings.split == (technique == 0 ? 4u : 1u));
        OK(hs_shot_set_settings(shot, &settings));
    }
    hs_shot_destroy(shot);
}

/* Knobs by name: the later one wins, and what they ask for is what is rendered. */
static void knobs(hs_context *context) {
    static float narrow[64], wide[64];
    float *results[2] = {narrow, wide};
    uint32_t i, pixel, brighter = 0;
    hs_shot *shot = make_shot(context, 8, 0.4);
    for (i = 0; i < 2; ++i) {
        hs_renderer *renderer = NULL;
        HEAD(hs_settings, settings, HS_TYPE_SETTINGS);
        HEAD(hs_knob, scale, HS_TYPE_KNOB);
        HEAD(hs_knob, again, HS_TYPE_KNOB);
        OK(hs_settings_default(HS_TECHNIQUE_SHADOW_WIDTH, &settings));
        scale.name = "scale";
        scale.value = "1000";
        again.name = "scale";
        again.value = "0";
        settings.next = &scale;
        scale.next = i == 1 ? &again : NULL;
        OK(hs_shot_set_settings(shot, &settings));
        OK(hs_renderer_create(shot, NULL, &renderer));
        OK(hs_renderer_render(renderer));
        OK(hs_renderer_visibility(renderer, 0, results[i], 64));
        hs_renderer_destroy(renderer);
    }
    /* Without scale nothing is shaded. */
    for (pixel = 0; pixel < 64; ++pixel) brighter += wide[pixel] > narrow[pixel] + 0.5f;
    CHECK(brighter > 0);
    hs_shot_destroy(shot);
}

int main(int argc, char **argv) {
    int user = 7;
    hs_context *context = NULL;
    hs_scene *scene = NULL;
    hs_shot *shot = NULL;
    HEAD(hs_context_info, info, HS_TYPE_CONTEXT_INFO);
    HEAD(hs_scene_counts, counts, HS_TYPE_SCENE_COUNTS);
    CHECK(argc == 3);
    CHECK(hs_abi_version() == HS_ABI_VERSION);
    CHECK(strlen(hs_version()) >= 5 && strcmp(hs_result_name(HS_IO), "HS_IO") == 0);
    info.flags = HS_CONTEXT_VALIDATE;
    info.log = count;
    info.log_user = &user;
    OK(hs_context_create(&info, &context));
    devices(context);
    textured_scene(context);
    techniques(context);
    knobs(context);
    frames(context);
    OK(hs_scene_load(context, argv[1], &scene));
    OK(hs_scene_describe(scene, &counts));
    CHECK(counts.triangles > 0);
    OK(hs_shot_create(scene, &shot));
    hs_shot_destroy(shot);
    hs_scene_destroy(scene);
    CHECK(hs_scene_load(context, argv[2], &scene) == HS_IO);
    CHECK(hs_scene_load(context, "/dev/null", &scene) == HS_PARSE);
    CHECK(hs_last_error(context, NULL, 0) > 1);
    hs_context_destroy(context);
    CHECK(messages == 0);
    return 0;
}
