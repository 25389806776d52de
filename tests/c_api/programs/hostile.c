/* Whatever is passed, a call ends with a code. Run with and without a device. */
#include <math.h>

#include "check.h"
#include "wrong.h"

static void of_contexts(hs_context *context, hs_scene *scene) {
    hs_context *made = context;
    uint64_t count;
    char text[4];
    HEAD(hs_context_info, info, HS_TYPE_CONTEXT_INFO);
    HEAD(hs_device_info, device, HS_TYPE_DEVICE_INFO);
    info.flags = HS_CONTEXT_WITHOUT_DEVICE;
    REFUSED(hs_context_create(&info, NULL));
    WRONG_STRUCTURES(info, hs_context_create(&info, &made));
    CHECK(made == NULL);
    REFUSED(hs_context_create(ODD(hs_context_info), &made));
    info.flags = 0x80000000u;
    REFUSED(hs_context_create(&info, &made));
    info.flags = HS_CONTEXT_WITHOUT_DEVICE;
    info.reserved = 1;
    REFUSED(hs_context_create(&info, &made));
    info.reserved = 0;
    info.device = "\xff\xfe";
    REFUSED(hs_context_create(&info, &made));
    REFUSED(hs_context_device(NULL, &device));
    REFUSED(hs_context_device((hs_context *)(void *)scene, &device));
    REFUSED(hs_context_device((hs_context *)(void *)&memory, &device));
    REFUSED(hs_context_validation_messages(context, NULL));
    REFUSED(hs_context_validation_messages(NULL, &count));
    REFUSED(hs_context_validation_messages(context, ODD(uint64_t)));
    REFUSED(hs_devices(NULL, NULL));
    CHECK(hs_last_error(NULL, text, sizeof text) > 4 && strlen(text) == 3);
    CHECK(hs_last_error(context, NULL, 1000) > 0);
    CHECK(hs_last_error((hs_context *)(void *)&memory, text, sizeof text) == 0);
    hs_context_destroy(NULL);
    hs_context_destroy((hs_context *)(void *)&memory);
    hs_context_destroy((hs_context *)(void *)scene);
}

static void of_scenes(hs_context *context) {
    static const uint32_t FAR[] = {0, 1, 0xffffffffu};
    float bad[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    hs_scene *scene = NULL;
    HEAD(hs_scene_info, info, HS_TYPE_SCENE_INFO);
    HEAD(hs_scene_counts, counts, HS_TYPE_SCENE_COUNTS);
    HEAD(hs_material, material, HS_TYPE_MATERIAL);
    HEAD(hs_texture, texture, HS_TYPE_TEXTURE);
    info.positions = CORNERS;
    info.vertex_count = 8;
    info.indices = INDICES;
    info.triangle_count = 4;
    REFUSED(hs_scene_create(NULL, &info, &scene));
    REFUSED(hs_scene_create(context, NULL, &scene));
    REFUSED(hs_scene_create(context, &info, NULL));
    REFUSED(hs_scene_create(context, ODD(hs_scene_info), &scene));
    WRONG_STRUCTURES(info, hs_scene_create(context, &info, &scene));
    info.vertex_count = UINT64_MAX; REFUSED(hs_scene_create(context, &info, &scene));
    info.vertex_count = UINT64_MAX / 3; REFUSED(hs_scene_create(context, &info, &scene));
    info.vertex_count = 0; REFUSED(hs_scene_create(context, &info, &scene));
    info.vertex_count = 7; REFUSED(hs_scene_create(context, &info, &scene));
    info.vertex_count = 8;
    info.triangle_count = UINT64_MAX; REFUSED(hs_scene_create(context, &info, &scene));
    info.triangle_count = (1u << 26) + 1; REFUSED(hs_scene_create(context, &info, &scene));
    info.indices = NULL; info.triangle_count = 3; REFUSED(hs_scene_create(context, &info, &scene));
    info.indices = FAR; info.triangle_count = 1; REFUSED(hs_scene_create(context, &info, &scene));
    info.indices = ODD(uint32_t); REFUSED(hs_scene_create(context, &info, &scene));
    info.indices = INDICES; info.triangle_count = 4;
    info.positions = NULL; REFUSED(hs_scene_create(context, &info, &scene));
    info.positions = ODD(float); REFUSED(hs_scene_create(context, &info, &scene));
    info.positions = bad; info.vertex_count = 3; info.indices = NULL; info.triangle_count = 1;
    bad[4] = NAN; REFUSED(hs_scene_create(context, &info, &scene));
    bad[4] = 1e30f; REFUSED(hs_scene_create(context, &info, &scene));
    bad[4] = 0;
    info.origin[2] = INFINITY; REFUSED(hs_scene_create(context, &info, &scene));
    info.origin[2] = 0;
    info.materials = &material; info.material_count = 1;
    material.texture = HS_NO_TEXTURE;
    WRONG_STRUCTURES(material, hs_scene_create(context, &info, &scene));
    info.material_count = UINT64_MAX; REFUSED(hs_scene_create(context, &info, &scene));
    info.material_count = 1;
    material.alpha_cutoff = NAN; REFUSED(hs_scene_create(context, &info, &scene));
    material.alpha_cutoff = 2; REFUSED(hs_scene_create(context, &info, &scene));
    material.alpha_cutoff = 0;
    material.double_sided = 2; REFUSED(hs_scene_create(context, &info, &scene));
    material.double_sided = 1;
    material.texture = 0; REFUSED(hs_scene_create(context, &info, &scene));
    info.textures = &texture; info.texture_count = 1;
    info.texcoords = bad;
    texture.width = texture.height = 1;
    REFUSED(hs_scene_create(context, &info, &scene));
    texture.rgba = memory.bytes + 1;
    WRONG_STRUCTURES(texture, hs_scene_create(context, &info, &scene));
    texture.width = 0xffffffffu; REFUSED(hs_scene_create(context, &info, &scene));
    texture.width = texture.height = 16384; info.texture_count = UINT64_MAX;
    REFUSED(hs_scene_create(context, &info, &scene));
    texture.width = texture.height = 1; info.texture_count = 1;
    texture.wrap[1] = 3; REFUSED(hs_scene_create(context, &info, &scene));
    texture.wrap[1] = 0;
    /* Bytes may stand anywhere, and all is right now. */
    OK(hs_scene_create(context, &info, &scene));
    REFUSED(hs_scene_describe(scene, NULL));
    REFUSED(hs_scene_describe(NULL, &counts));
    REFUSED(hs_scene_describe((hs_scene *)(void *)context, &counts));
    WRONG_STRUCTURES(counts, hs_scene_describe(scene, &counts));
    hs_scene_destroy(scene);
    REFUSED(hs_scene_describe(scene, &counts));
    hs_scene_destroy(scene);
    hs_scene_destroy(NULL);
    REFUSED(hs_scene_load(context, NULL, &scene));
    REFUSED(hs_scene_load(context, "\xff", &scene));
    REFUSED(hs_scene_load(context, "a", NULL));
    REFUSED(hs_scene_load(NULL, "a", &scene));
    CHECK(hs_scene_load(context, "", &scene) == HS_IO && scene == NULL);
}

static void of_polygons(hs_shot *shot, hs_light light) {
    double corners[] = {0, 2, 0, 1, 2, 0, 1, 2, 1, 0, 2, 1};
    HEAD(hs_polygon, polygon, HS_TYPE_POLYGON);
    polygon.corners = corners;
    polygon.corner_count = 4;
    light.shape = HS_LIGHT_POLYGON;
    REFUSED(hs_shot_set_lights(shot, &light, 1));
    light.next = &polygon;
    OK(hs_shot_set_lights(shot, &light, 1));
    polygon.next = &polygon; REFUSED(hs_shot_set_lights(shot, &light, 1));
    polygon.next = NULL;
    polygon.size -= 8; REFUSED(hs_shot_set_lights(shot, &light, 1));
    polygon.size += 8;
    polygon.corner_count = 2; REFUSED(hs_shot_set_lights(shot, &light, 1));
    polygon.corner_count = UINT64_MAX; REFUSED(hs_shot_set_lights(shot, &light, 1));
    polygon.corner_count = 4;
    polygon.corners = NULL; REFUSED(hs_shot_set_lights(shot, &light, 1));
    polygon.corners = corners;
    corners[1] = 7; REFUSED(hs_shot_set_lights(shot, &light, 1));
    corners[1] = NAN; REFUSED(hs_shot_set_lights(shot, &light, 1));
    corners[1] = 2;
    light.shape = HS_LIGHT_DISC; REFUSED(hs_shot_set_lights(shot, &light, 1));
}

static void of_shots(hs_context *context) {
    hs_scene *scene = make_scene(context);
    hs_shot *shot = NULL;
    HEAD(hs_camera, camera, HS_TYPE_CAMERA);
    HEAD(hs_light, light, HS_TYPE_LIGHT);
    HEAD(hs_settings, settings, HS_TYPE_SETTINGS);
    HEAD(hs_knob, knob, HS_TYPE_KNOB);
    HEAD(hs_shot_counts, counts, HS_TYPE_SHOT_COUNTS);
    HEAD(hs_reference_info, reference, HS_TYPE_REFERENCE_INFO);
    float value[4];
    REFUSED(hs_shot_create(NULL, &shot));
    REFUSED(hs_shot_create(scene, NULL));
    REFUSED(hs_shot_create((hs_scene *)(void *)context, &shot));
    OK(hs_shot_create(scene, &shot));
    camera.up[1] = camera.eye[2] = 1;
    camera.vfov_deg = 45;
    camera.width = camera.height = 2;
    REFUSED(hs_shot_set_camera(NULL, &camera));
    REFUSED(hs_shot_set_camera(shot, NULL));
    REFUSED(hs_shot_set_camera(shot, ODD(hs_camera)));
    WRONG_STRUCTURES(camera, hs_shot_set_camera(shot, &camera));
    camera.width = 0; REFUSED(hs_shot_set_camera(shot, &camera));
    camera.width = 32769; REFUSED(hs_shot_set_camera(shot, &camera));
    camera.width = 2;
    camera.eye[0] = NAN; REFUSED(hs_shot_set_camera(shot, &camera));
    camera.eye[0] = 0;
    camera.vfov_deg = 180; REFUSED(hs_shot_set_camera(shot, &camera));
    camera.vfov_deg = 45;
    OK(hs_shot_set_camera(shot, &camera));
    REFUSED(hs_shot_set_lights(NULL, &light, 1));
    REFUSED(hs_shot_set_lights(shot, NULL, 1));
    REFUSED(hs_shot_set_lights(shot, &light, UINT64_MAX));
    REFUSED(hs_shot_set_lights(shot, ODD(hs_light), 1));
    light.shape = HS_LIGHT_DISC;
    light.normal[1] = -1;
    light.radius = 1;
    light.center[1] = 2;
    WRONG_STRUCTURES(light, hs_shot_set_lights(shot, &light, 1));
    light.shape = 5; REFUSED(hs_shot_set_lights(shot, &light, 1));
    of_polygons(shot, light);
    light.shape = HS_LIGHT_DISC;
    light.radius = -1; REFUSED(hs_shot_set_lights(shot, &light, 1));
    light.radius = 1;
    light.intensity = NAN; REFUSED(hs_shot_set_lights(shot, &light, 1));
    light.intensity = 1;
    OK(hs_shot_set_lights(shot, &light, 1));
    REFUSED(hs_settings_default(1000, &settings));
    REFUSED(hs_settings_default(0, NULL));
    WRONG_STRUCTURES(settings, hs_settings_default(0, &settings));
    OK(hs_settings_default(0, &settings));
    REFUSED(hs_shot_set_settings(NULL, &settings));
    WRONG_STRUCTURES(settings, hs_shot_set_settings(shot, &settings));
    knob.name = "map";
    knob.value = "64";
    settings.next = &knob;
    OK(hs_shot_set_settings(shot, &settings));
    WRONG_STRUCTURES(knob, hs_shot_set_settings(shot, &settings));
    knob.value = "15";
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.value = "a";
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.value = "\xff";
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.value = NULL;
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.value = "64";
    knob.name = "no such knob";
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.name = NULL;
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.name = "no-gap-filling";
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.value = "1";
    OK(hs_shot_set_settings(shot, &settings));
    /* A chain without end. */
    knob.next = &knob;
    REFUSED(hs_shot_set_settings(shot, &settings));
    knob.next = NULL;
    settings.next = NULL;
    {
        uint32_t *number;
        for (number = &settings.technique; number <= &settings.maps; ++number) {
            uint32_t right = *number;
            *number = 0xffffffffu;
            REFUSED(hs_shot_set_settings(shot, &settings));
            *number = right;
        }
    }
    settings.bias = NAN; REFUSED(hs_shot_set_settings(shot, &settings));
    settings.bias = 1;
    OK(hs_shot_set_settings(shot, &settings));
    REFUSED(hs_shot_describe(shot, NULL));
    REFUSED(hs_shot_describe(NULL, &counts));
    WRONG_STRUCTURES(counts, hs_shot_describe(shot, &counts));
    OK(hs_shot_describe(shot, &counts));
    CHECK(counts.width == 2 && counts.lights == 1);
    reference.samples = 16;
    REFUSED(hs_reference(NULL, &reference, value, NULL, NULL, 4));
    REFUSED(hs_reference(shot, NULL, value, NULL, NULL, 4));
    REFUSED(hs_reference(shot, &reference, value, NULL, NULL, UINT64_MAX));
    REFUSED(hs_reference(shot, &reference, ODD(float), NULL, NULL, 4));
    WRONG_STRUCTURES(reference, hs_reference(shot, &reference, value, NULL, NULL, 4));
    reference.samples = 1; REFUSED(hs_reference(shot, &reference, value, NULL, NULL, 4));
    reference.samples = 16;
    reference.light = 1; REFUSED(hs_reference(shot, &reference, value, NULL, NULL, 4));
    reference.light = 0;
    OK(hs_reference(shot, &reference, value, NULL, NULL, 4));
    OK(hs_shot_set_lights(shot, NULL, 0));
    REFUSED(hs_reference(shot, &reference, value, NULL, NULL, 4));
    REFUSED(hs_shot_load(NULL, "a", &shot));
    {
        hs_shot *other = shot;
        REFUSED(hs_shot_load(context, NULL, &other));
        CHECK(other == NULL);
    }
    hs_shot_destroy(shot);
    hs_shot_destroy(shot);
    hs_shot_destroy(NULL);
    REFUSED(hs_shot_describe(shot, &counts));
    hs_scene_destroy(scene);
}

static void of_renderers(hs_context *context) {
    hs_shot *shot = make_shot(context, 8, 0.4);
    hs_renderer *renderer = NULL;
    float value[64];
    uint8_t bytes[256];
    HEAD(hs_renderer_info, info, HS_TYPE_RENDERER_INFO);
    HEAD(hs_statistics, statistics, HS_TYPE_STATISTICS);
    HEAD(hs_pass, pass, HS_TYPE_PASS);
    info.exposure = 1;
    info.picture = 1;
    REFUSED(hs_renderer_create(NULL, &info, &renderer));
    REFUSED(hs_renderer_create(shot, &info, NULL));
    WRONG_STRUCTURES(info, hs_renderer_create(shot, &info, &renderer));
    info.exposure = NAN; REFUSED(hs_renderer_create(shot, &info, &renderer));
    info.exposure = 1;
    info.ambient = -1; REFUSED(hs_renderer_create(shot, &info, &renderer));
    info.ambient = 0;
    info.edge_cost = -1; CHECK(hs_renderer_create(shot, &info, &renderer) != HS_OK && renderer == NULL);
    info.edge_cost = 0;
    REFUSED(hs_renderer_render(NULL));
    REFUSED(hs_renderer_render((hs_renderer *)(void *)shot));
    REFUSED(hs_renderer_visibility(NULL, 0, value, 64));
    REFUSED(hs_renderer_picture(NULL, bytes, 256));
    REFUSED(hs_renderer_statistics(NULL, &statistics));
    REFUSED(hs_renderer_pass(NULL, 0, &pass));
    hs_renderer_destroy(NULL);
    {
        HEAD(hs_device_info, device, HS_TYPE_DEVICE_INFO);
        if (hs_context_device(context, &device) == HS_UNSUPPORTED) {
            CHECK(hs_renderer_create(shot, &info, &renderer) == HS_UNSUPPORTED && renderer == NULL);
            hs_shot_destroy(shot);
            return;
        }
        WRONG_STRUCTURES(device, hs_context_device(context, &device));
    }
    OK(hs_renderer_create(shot, &info, &renderer));
    OK(hs_renderer_render(renderer));
    REFUSED(hs_renderer_visibility(renderer, 0, NULL, 64));
    REFUSED(hs_renderer_visibility(renderer, 0, value, UINT64_MAX));
    REFUSED(hs_renderer_visibility(renderer, 0xffffffffu, value, 64));
    REFUSED(hs_renderer_visibility(renderer, 0, ODD(float), 64));
    REFUSED(hs_renderer_picture(renderer, NULL, 256));
    REFUSED(hs_renderer_picture(renderer, bytes, 64));
    OK(hs_renderer_picture(renderer, memory.bytes + 1, 256));
    REFUSED(hs_renderer_statistics(renderer, NULL));
    WRONG_STRUCTURES(statistics, hs_renderer_statistics(renderer, &statistics));
    REFUSED(hs_renderer_pass(renderer, 0xffffffffu, &pass));
    WRONG_STRUCTURES(pass, hs_renderer_pass(renderer, 0, &pass));
    hs_renderer_destroy(renderer);
    hs_renderer_destroy(renderer);
    REFUSED(hs_renderer_render(renderer));
    hs_shot_destroy(shot);
}

int main(int argc, char **argv) {
    hs_context *context = make_context(argc > 1 && strcmp(argv[1], "device") == 0 ? 0 : HS_CONTEXT_WITHOUT_DEVICE);
    hs_scene *scene = make_scene(context);
    uint64_t count;
    of_contexts(context, scene);
    of_scenes(context);
    of_shots(context);
    of_renderers(context);
    hs_context_destroy(context);
    REFUSED(hs_context_validation_messages(context, &count));
    hs_scene_destroy(scene);
    CHECK(strcmp(hs_result_name(-5), "an unknown result") == 0);
    return 0;
}
