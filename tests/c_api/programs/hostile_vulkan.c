/* Whatever is passed to the host-owned tier, a call ends with a code. */
#include <math.h>

#include "check.h"
#include "halfshade_vulkan.h"
#include "wrong.h"

static VkInstance instance;
static VkPhysicalDevice physical;

static void of_devices(void) {
    VkPhysicalDeviceVulkan13Features v13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
    VkPhysicalDeviceFeatures2 lone = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceFeatures2 other = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
    const char *names[] = {NULL};
    VkAllocationCallbacks empty = {0};
    hs_context *context = NULL;
    HEAD(hs_vk_requirements, needs, HS_TYPE_VK_REQUIREMENTS);
    HEAD(hs_vk_device_info, info, HS_TYPE_VK_DEVICE_INFO);
    REFUSED(hs_vk_query_requirements(NULL, physical, vkGetInstanceProcAddr, NULL, &needs));
    REFUSED(hs_vk_query_requirements(instance, NULL, vkGetInstanceProcAddr, NULL, &needs));
    REFUSED(hs_vk_query_requirements(instance, physical, NULL, NULL, &needs));
    REFUSED(hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, NULL, NULL));
    REFUSED(hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, &other, &needs));
    REFUSED(hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, &lone, &needs));
    REFUSED(hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, ODD(VkPhysicalDeviceFeatures2), &needs));
    WRONG_STRUCTURES(needs, hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, NULL, &needs));
    CHECK(v13.dynamicRendering == VK_FALSE);
    OK(hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, &features, &needs));
    CHECK(v13.dynamicRendering && v13.synchronization2 && v13.maintenance4 && v12.scalarBlockLayout);
    CHECK(features.features.shaderStorageImageExtendedFormats && !v12.bufferDeviceAddress);
    CHECK(needs.usable == 1 && needs.recommended_extension_count == 1);
    CHECK(strcmp(needs.recommended_extensions[0], VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0);
    REFUSED(hs_vk_context_create(NULL, &context));
    REFUSED(hs_vk_context_create(&info, NULL));
    WRONG_STRUCTURES(info, hs_vk_context_create(&info, &context));
    info.instance = instance;
    info.physical_device = physical;
    info.get_instance_proc_addr = vkGetInstanceProcAddr;
    info.features = &features;
    info.api_version = VK_API_VERSION_1_3;
    REFUSED(hs_vk_context_create(&info, &context));
    {
        /* A device without any feature: what the library needs is there, but not enabled. */
        const float priority = 1;
        VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
        VkDeviceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue};
        char text[512];
        CHECK(vkCreateDevice(physical, &create, NULL, &info.device) == VK_SUCCESS);
        info.features = &lone;
        CHECK(hs_vk_context_create(&info, &context) == HS_UNSUPPORTED && context == NULL);
        hs_last_error(NULL, text, sizeof text);
        CHECK(strstr(text, "dynamicRendering enabled") != NULL);
        info.features = NULL;
        REFUSED(hs_vk_context_create(&info, &context));
        info.features = &features;
        info.extensions = names;
        info.extension_count = 1;
        REFUSED(hs_vk_context_create(&info, &context));
        info.extension_count = UINT64_MAX;
        REFUSED(hs_vk_context_create(&info, &context));
        info.extension_count = 0;
        info.allocator = &empty;
        REFUSED(hs_vk_context_create(&info, &context));
        info.allocator = NULL;
        info.api_version = VK_API_VERSION_1_2;
        CHECK(hs_vk_context_create(&info, &context) == HS_UNSUPPORTED);
        info.api_version = VK_API_VERSION_1_3;
        info.queue_family = 0xffffffffu;
        CHECK(hs_vk_context_create(&info, &context) == HS_UNSUPPORTED);
        vkDestroyDevice(info.device, NULL);
    }
}

static void of_effects(hs_context *context) {
    hs_vk_effect *effect = NULL;
    VkCommandBuffer commands = (VkCommandBuffer)(void *)&memory;
    HEAD(hs_light, light, HS_TYPE_LIGHT);
    HEAD(hs_settings, settings, HS_TYPE_SETTINGS);
    HEAD(hs_vk_effect_info, info, HS_TYPE_VK_EFFECT_INFO);
    HEAD(hs_vk_image, image, HS_TYPE_VK_IMAGE);
    HEAD(hs_vk_slot, slot, HS_TYPE_VK_SLOT);
    HEAD(hs_vk_mesh, mesh, HS_TYPE_VK_MESH);
    HEAD(hs_vk_prepare_info, prepare, HS_TYPE_VK_PREPARE_INFO);
    HEAD(hs_vk_frame, frame, HS_TYPE_VK_FRAME);
    HEAD(hs_vk_effect_state, state, HS_TYPE_VK_EFFECT_STATE);
    light.u[0] = light.v[2] = light.center[1] = 1;
    OK(hs_settings_default(HS_TECHNIQUE_PACKET_CONTOUR, &settings));
    settings.split = 1;
    info.width = info.height = 8;
    info.light = &light;
    info.settings = &settings;
    REFUSED(hs_vk_effect_create(NULL, &info, &effect));
    REFUSED(hs_vk_effect_create(context, NULL, &effect));
    REFUSED(hs_vk_effect_create(context, &info, NULL));
    WRONG_STRUCTURES(info, hs_vk_effect_create(context, &info, &effect));
    WRONG_STRUCTURES(light, hs_vk_effect_create(context, &info, &effect));
    WRONG_STRUCTURES(settings, hs_vk_effect_create(context, &info, &effect));
    info.light = NULL; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.light = &light;
    info.width = 0; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.width = 0xffffffffu; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.width = 8;
    info.casters = 3; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.casters = HS_VK_CASTERS_MAPS;
    info.side_faces = 1; CHECK(hs_vk_effect_create(context, &info, &effect) == HS_UNSUPPORTED);
    info.side_faces = 2; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.side_faces = 0;
    info.casters = HS_VK_CASTERS_MESHES;
    info.surface = 2; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.surface = 0;
    info.normals = 3; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.normals = 0;
    info.triangle_max = 0xffffffffu; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.triangle_max = info.vertex_max = 0x55555555u; CHECK(hs_vk_effect_create(context, &info, &effect) == HS_UNSUPPORTED);
    info.triangle_max = info.vertex_max = 16;
    info.edge_cost = NAN; REFUSED(hs_vk_effect_create(context, &info, &effect));
    info.edge_cost = 0;
    OK(hs_vk_effect_create(context, &info, &effect));

    REFUSED(hs_vk_effect_describe(NULL, &state));
    REFUSED(hs_vk_effect_describe(effect, NULL));
    WRONG_STRUCTURES(state, hs_vk_effect_describe(effect, &state));
    OK(hs_vk_effect_describe(effect, &state));
    CHECK(state.prepared == 0 && state.memory_bytes == 0 && state.view_count == 1);

    image.width = image.height = 8;
    image.current_layout = VK_IMAGE_LAYOUT_GENERAL;
    image.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    slot.surface = slot.normal = slot.visibility = &image;
    prepare.slots = &slot;
    prepare.slot_count = 1;
    REFUSED(hs_vk_effect_prepare(NULL, &prepare));
    REFUSED(hs_vk_effect_prepare(effect, NULL));
    WRONG_STRUCTURES(prepare, hs_vk_effect_prepare(effect, &prepare));
    WRONG_STRUCTURES(slot, hs_vk_effect_prepare(effect, &prepare));
    WRONG_STRUCTURES(image, hs_vk_effect_prepare(effect, &prepare));
    REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.image = (VkImage)(void *)&memory;
    image.width = 7; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.width = 8;
    image.usage = 0; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    image.current_layout = VK_IMAGE_LAYOUT_UNDEFINED; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.current_layout = VK_IMAGE_LAYOUT_GENERAL;
    /* One image for all, and formats that cannot be what they are lent as. */
    image.format = VK_FORMAT_R32G32B32A32_SFLOAT; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.format = VK_FORMAT_UNDEFINED; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.format = VK_FORMAT_R32_UINT; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    image.format = VK_FORMAT_R8_UINT; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    slot.maps = &image; slot.map_count = 1; CHECK(hs_vk_effect_prepare(effect, &prepare) != HS_OK);
    slot.map_count = UINT64_MAX; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    slot.maps = NULL; slot.map_count = 0;
    slot.surface = NULL; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    slot.surface = &image;
    prepare.slot_count = 0; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    prepare.slot_count = UINT64_MAX; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    prepare.slot_count = 1;
    prepare.meshes = &mesh;
    prepare.mesh_count = UINT64_MAX; REFUSED(hs_vk_effect_prepare(effect, &prepare));
    prepare.mesh_count = 1;
    WRONG_STRUCTURES(mesh, hs_vk_effect_prepare(effect, &prepare));
    CHECK(hs_vk_effect_prepare(effect, &prepare) != HS_OK);

    REFUSED(hs_vk_effect_record(NULL, commands, &frame));
    REFUSED(hs_vk_effect_record(effect, NULL, &frame));
    REFUSED(hs_vk_effect_record(effect, commands, NULL));
    WRONG_STRUCTURES(frame, hs_vk_effect_record(effect, commands, &frame));
    CHECK(hs_vk_effect_record(effect, commands, &frame) == HS_NOT_READY);
    REFUSED(hs_vk_effect_collect(NULL, 1));
    REFUSED(hs_vk_effect_collect(effect, UINT64_MAX));
    OK(hs_vk_effect_collect(effect, 0));
    hs_vk_effect_destroy(NULL);
    hs_vk_effect_destroy((hs_vk_effect *)(void *)context);
    hs_vk_effect_destroy(effect);
    hs_vk_effect_destroy(effect);
    REFUSED(hs_vk_effect_collect(effect, 1));
}

/* An effect on a context that has no device of a host's. */
static void elsewhere(uint32_t flags) {
    hs_context *context = make_context(flags);
    hs_vk_effect *effect = NULL;
    HEAD(hs_light, light, HS_TYPE_LIGHT);
    HEAD(hs_vk_effect_info, info, HS_TYPE_VK_EFFECT_INFO);
    info.width = info.height = 8;
    info.light = &light;
    CHECK(hs_vk_effect_create(context, &info, &effect) == HS_UNSUPPORTED && effect == NULL);
    hs_context_destroy(context);
}

int main(void) {
    const float priority = 1;
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkPhysicalDeviceVulkan13Features v13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = &features, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue};
    hs_context *context = NULL;
    hs_shot *shot;
    hs_renderer *renderer = NULL;
    uint32_t count = 1;
    HEAD(hs_vk_requirements, needs, HS_TYPE_VK_REQUIREMENTS);
    HEAD(hs_vk_device_info, info, HS_TYPE_VK_DEVICE_INFO);
    CHECK(vkCreateInstance(&create, NULL, &instance) == VK_SUCCESS);
    CHECK(vkEnumeratePhysicalDevices(instance, &count, &physical) >= VK_SUCCESS && count == 1);
    of_devices();
    elsewhere(HS_CONTEXT_WITHOUT_DEVICE);
    elsewhere(0);
    OK(hs_vk_query_requirements(instance, physical, vkGetInstanceProcAddr, &features, &needs));
    CHECK(vkCreateDevice(physical, &device, NULL, &info.device) == VK_SUCCESS);
    info.instance = instance;
    info.physical_device = physical;
    info.get_instance_proc_addr = vkGetInstanceProcAddr;
    info.api_version = VK_API_VERSION_1_3;
    info.features = &features;
    OK(hs_vk_context_create(&info, &context));
    of_effects(context);
    /* Only the host submits to its device. */
    shot = make_shot(context, 8, 0.4);
    CHECK(hs_renderer_create(shot, NULL, &renderer) == HS_UNSUPPORTED && renderer == NULL);
    hs_shot_destroy(shot);
    hs_context_destroy(context);
    vkDestroyDevice(info.device, NULL);
    vkDestroyInstance(instance, NULL);
    return 0;
}
