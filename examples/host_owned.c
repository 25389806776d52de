/* An engine with a Vulkan device of its own: soft shadows of a window-sized light, recorded into its command buffers,
 * with two frames in flight. The engine's depths, normals and shadow map are filled by the CPU, where a real one draws.
 *
 *     host_owned meshes   [FRAMES]            casters in vertex and index buffers
 *     host_owned callback [FRAMES] SHADOW.spv casters drawn by a pipeline of the engine's
 *     host_owned maps     [FRAMES]            a shadow map that the engine has already
 *
 * Runs under the validation layer when it is there; any message fails it, as does a wrong visibility. */
#define _POSIX_C_SOURCE 200112L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "halfshade_vulkan.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, MAP = 256, FRAMES_IN_FLIGHT = 2 };

#define CHECK(condition)                                                                                \
    do {                                                                                                \
        if (!(condition)) {                                                                             \
            char sentence_[512] = "";                                                                   \
            hs_last_error(NULL, sentence_, sizeof sentence_);                                           \
            fprintf(stderr, "%s:%d: %s (last error: %s)\n", __FILE__, __LINE__, #condition, sentence_); \
            exit(1);                                                                                    \
        }                                                                                               \
    } while (0)
#define VK(call) CHECK((call) == VK_SUCCESS)
#define HS(call) CHECK((call) == HS_OK)

/* Everything the engine has; zero-initialised. */
static struct {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    VkCommandPool pool;
    VkCommandBuffer commands[FRAMES_IN_FLIGHT];
    VkFence fences[FRAMES_IN_FLIGHT];
    VkBuffer staging;
    VkDeviceMemory staging_memory, memories[32];
    unsigned char *staged;
    VkImage images[16];
    VkBuffer buffers[8];
    unsigned memory_count, image_count, buffer_count, messages;
    /* For the callback. */
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool set_pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
} engine;

/* The library's memory on the host goes through the engine. */
static unsigned live_allocations, allocations;

static void *VKAPI_PTR allocate(void *user, size_t size, size_t alignment, VkSystemAllocationScope scope) {
    void *place = NULL;
    (void)user, (void)scope;
    if (alignment < sizeof(void *)) alignment = sizeof(void *);
    if (size == 0 || posix_memalign(&place, alignment, size) != 0) return NULL;
    ++live_allocations, ++allocations;
    return place;
}

static void VKAPI_PTR release(void *user, void *place) {
    (void)user;
    if (place != NULL) --live_allocations;
    free(place);
}

static void *VKAPI_PTR reallocate(void *user, void *place, size_t size, size_t alignment, VkSystemAllocationScope scope) {
    (void)user, (void)alignment, (void)scope;
    if (place == NULL) return allocate(user, size, alignment, scope);
    if (size == 0) return release(user, place), NULL;
    return realloc(place, size);
}

static VkBool32 VKAPI_PTR say(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
                              const VkDebugUtilsMessengerCallbackDataEXT *data, void *user) {
    (void)severity, (void)types, (void)user;
    ++engine.messages;
    fprintf(stderr, "%s\n", data->pMessage);
    return VK_FALSE;
}

static void create_instance(void) {
    static const char *layers[] = {"VK_LAYER_KHRONOS_validation"};
    static const char *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    static const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT
                       | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = say};
    VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, .pNext = &messenger,
                                        .enabledValidationFeatureCount = 1, .pEnabledValidationFeatures = &synchronization};
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    if (getenv("HOST_OWNED_WITHOUT_VALIDATION") == NULL) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = extensions;
    }
    VK(vkCreateInstance(&info, NULL, &engine.instance));
    if (info.enabledLayerCount > 0) {
        PFN_vkCreateDebugUtilsMessengerEXT create =
            (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(engine.instance, "vkCreateDebugUtilsMessengerEXT");
        CHECK(create != NULL);
        VK(create(engine.instance, &messenger, NULL, &engine.messenger));
    }
}

/* A device with exactly what the library says it needs, and a context on it. */
static hs_context *create_device(void) {
    static const char *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    const float priority = 1;
    uint32_t count = 1, i;
    hs_context *context = NULL;
    VkQueueFamilyProperties families[16];
    VkAllocationCallbacks callbacks = {.pfnAllocation = allocate, .pfnReallocation = reallocate, .pfnFree = release};
    VkPhysicalDeviceVulkan13Features v13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
    hs_vk_requirements needs = {.type = HS_TYPE_VK_REQUIREMENTS, .size = sizeof needs};
    CHECK(vkEnumeratePhysicalDevices(engine.instance, &count, &engine.physical) >= VK_SUCCESS && count == 1);
    HS(hs_vk_query_requirements(engine.instance, engine.physical, vkGetInstanceProcAddr, &features, &needs));
    if (!needs.usable) fprintf(stderr, "the device lacks %s\n", needs.missing);
    CHECK(needs.usable && needs.api_version <= VK_API_VERSION_1_3 && needs.required_extension_count == 0);
    count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(engine.physical, &count, families);
    for (i = 0; i < count && (families[i].queueFlags & needs.queue_flags) != needs.queue_flags; ++i) {}
    CHECK(i < count);
    engine.family = i;
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueFamilyIndex = engine.family,
                                     .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = &features, .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
    VK(vkCreateDevice(engine.physical, &info, NULL, &engine.device));
    vkGetDeviceQueue(engine.device, engine.family, 0, &engine.queue);
    hs_vk_device_info device = {.type = HS_TYPE_VK_DEVICE_INFO, .size = sizeof device,
                                .instance = engine.instance, .physical_device = engine.physical, .device = engine.device,
                                .get_instance_proc_addr = vkGetInstanceProcAddr, .api_version = VK_API_VERSION_1_3,
                                .queue_family = engine.family, .features = &features, .allocator = &callbacks};
    device.extensions = extensions;
    device.extension_count = engine.messenger != VK_NULL_HANDLE;
    HS(hs_vk_context_create(&device, &context));
    return context;
}

static VkDeviceMemory take_memory(VkMemoryRequirements needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties kinds;
    uint32_t i;
    vkGetPhysicalDeviceMemoryProperties(engine.physical, &kinds);
    for (i = 0; i < kinds.memoryTypeCount; ++i) {
        if ((needs.memoryTypeBits >> i & 1) != 0 && (kinds.memoryTypes[i].propertyFlags & wanted) == wanted) break;
    }
    CHECK(i < kinds.memoryTypeCount && engine.memory_count < 32);
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = i};
    VK(vkAllocateMemory(engine.device, &info, NULL, &engine.memories[engine.memory_count]));
    return engine.memories[engine.memory_count++];
}

/* A buffer that the CPU can write, with `bytes` of `data`. */
static VkBuffer make_buffer(const void *data, VkDeviceSize bytes, VkBufferUsageFlags usage, VkDeviceMemory *memory) {
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    VkMemoryRequirements needs;
    VkBuffer buffer;
    void *place;
    VK(vkCreateBuffer(engine.device, &info, NULL, &buffer));
    vkGetBufferMemoryRequirements(engine.device, buffer, &needs);
    *memory = take_memory(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(engine.device, buffer, *memory, 0));
    if (data != NULL) {
        VK(vkMapMemory(engine.device, *memory, 0, bytes, 0, &place));
        memcpy(place, data, bytes);
        vkUnmapMemory(engine.device, *memory);
    }
    engine.buffers[engine.buffer_count++] = buffer;
    return buffer;
}

static VkImageAspectFlags aspect_of(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

static void barrier(VkCommandBuffer commands, VkImage image, VkFormat format, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 turn = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT, .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, .oldLayout = from, .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED, .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED, .image = image,
        .subresourceRange = {aspect_of(format), 0, 1, 0, 1}};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &turn};
    vkCmdPipelineBarrier2(commands, &info);
}

static VkCommandBuffer begin(unsigned turn) {
    VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkWaitForFences(engine.device, 1, &engine.fences[turn], VK_TRUE, UINT64_MAX));
    VK(vkResetFences(engine.device, 1, &engine.fences[turn]));
    VK(vkBeginCommandBuffer(engine.commands[turn], &info));
    return engine.commands[turn];
}

static void submit(unsigned turn) {
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &engine.commands[turn]};
    VK(vkEndCommandBuffer(engine.commands[turn]));
    VK(vkQueueSubmit(engine.queue, 1, &info, engine.fences[turn]));
}

/* An image as the library is told of it: the engine keeps it for shaders to read. */
static hs_vk_image make_image(VkFormat format, uint32_t side, VkImageUsageFlags usage, const void *data, size_t bytes) {
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, .imageType = VK_IMAGE_TYPE_2D, .format = format,
                              .extent = {side, side, 1}, .mipLevels = 1, .arrayLayers = 1, .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage = usage};
    VkBufferImageCopy region = {.imageSubresource = {aspect_of(format), 0, 0, 1}, .imageExtent = {side, side, 1}};
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED;
    VkMemoryRequirements needs;
    VkImage image;
    VkCommandBuffer commands = begin(0);
    VK(vkCreateImage(engine.device, &info, NULL, &image));
    vkGetImageMemoryRequirements(engine.device, image, &needs);
    VK(vkBindImageMemory(engine.device, image, take_memory(needs, 0), 0));
    engine.images[engine.image_count++] = image;
    if (data != NULL) {
        memcpy(engine.staged, data, bytes);
        from = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier(commands, image, format, VK_IMAGE_LAYOUT_UNDEFINED, from);
        vkCmdCopyBufferToImage(commands, engine.staging, image, from, 1, &region);
    }
    barrier(commands, image, format, from, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    submit(0);
    VK(vkQueueWaitIdle(engine.queue));
    return (hs_vk_image){.type = HS_TYPE_VK_IMAGE, .size = sizeof(hs_vk_image), .image = image, .format = format,
                         .width = side, .height = side, .usage = usage,
                         .current_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                         .current_stage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                         .current_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
}

/* The world: a floor of 4 x 4 at height 0, a plate of 1 x 1 at height 1, a light of 1 x 1 at height 3 that shines down.
 * The camera hangs at height 4 and looks down, x to the right and z downwards; its depth is near / distance. */
static const float CORNERS[] = {-2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2, -0.5f, 0, -0.5f, 0.5f, 0, -0.5f, 0.5f, 0, 0.5f, -0.5f, 0, 0.5f};
static const uint16_t INDICES[] = {0, 2, 1, 0, 3, 2, 4, 6, 5, 4, 7, 6};
static const float FOCAL = 1.7f, NEAR = 0.1f, EYE = 4, LIGHT = 3;

/* Where a pixel's ray meets the world: 0 floor, 1 plate, -1 nothing. */
static int hit(int pixel, float *x, float *z) {
    const float clip_x = 2 * (pixel % SIDE + 0.5f) / SIDE - 1, clip_z = 2 * (pixel / SIDE + 0.5f) / SIDE - 1;
    int height;
    for (height = 1; height >= 0; --height) {
        const float reach = height == 1 ? 0.5f : 2, distance = EYE - (float)height;
        *x = clip_x * distance / FOCAL;
        *z = clip_z * distance / FOCAL;
        if (*x >= -reach && *x <= reach && *z >= -reach && *z <= reach) return height;
    }
    return -1;
}

/* The share of [-0.5, 0.5] that the plate's shadow from the floor point leaves free, along one axis. */
static double hidden_along(double at) {
    double low = at + (-0.5 - at) * LIGHT, high = at + (0.5 - at) * LIGHT;
    if (low < -0.5) low = -0.5;
    if (high > 0.5) high = 0.5;
    return high > low ? high - low : 0;
}

/* Against the closed form. Each of the plate's edges is up to half a texel off, one along each axis, and the bias takes up to
 * half a texel more; 0.01 is the rest. `texel`: of the light's width, as far as a texel moves the plate's shadow. */
static void check_visibility(const float *visibility, float background, double texel) {
    const double most = 1.5 * texel + 0.01;
    int i, partly = 0;
    for (i = 0; i < PIXELS; ++i) {
        float x, z;
        const int height = hit(i, &x, &z);
        const double expected = height < 0 ? background : height == 1 ? 1 : 1 - hidden_along(x) * hidden_along(z);
        const double error = visibility[i] - expected;
        if (!(error < most && error > -most)) {
            fprintf(stderr, "pixel %d: %f instead of %f\n", i, visibility[i], expected);
            exit(1);
        }
        partly += expected > 0.1 && expected < 0.9;
    }
    CHECK(partly > 100);
}

/* The engine's own shadow map from the light's centre, wide enough for its casters: depths of the usual kind, 0 near ... 1 far. */
static const float MAP_NEAR = 0.5f, MAP_FAR = 10, MAP_FOCAL = 3.5f;

static hs_vk_image make_map(hs_vk_map *map) {
    static float depths[MAP * MAP];
    const float scale = MAP_FAR / (MAP_FAR - MAP_NEAR);
    int i;
    for (i = 0; i < MAP * MAP; ++i) {
        const float x = (2 * (i % MAP + 0.5f) / MAP - 1) / MAP_FOCAL, z = (2 * (i / MAP + 0.5f) / MAP - 1) / MAP_FOCAL;
        const int plate = x * (LIGHT - 1) >= -0.5f && x * (LIGHT - 1) <= 0.5f && z * (LIGHT - 1) >= -0.5f && z * (LIGHT - 1) <= 0.5f;
        depths[i] = plate ? scale - scale * MAP_NEAR / (LIGHT - 1) : 1;
    }
    /* Columns: x to the right, z downwards, w the distance below the light. */
    memset(map, 0, sizeof *map);
    map->type = HS_TYPE_VK_MAP;
    map->size = sizeof *map;
    map->clip_from_world[0] = MAP_FOCAL;
    map->clip_from_world[6] = -scale;
    map->clip_from_world[7] = -1;
    map->clip_from_world[9] = MAP_FOCAL;
    map->clip_from_world[14] = scale * LIGHT - scale * MAP_NEAR;
    map->clip_from_world[15] = LIGHT;
    map->depth_empty = 1;
    return make_image(VK_FORMAT_D32_SFLOAT, MAP, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, depths, sizeof depths);
}

/* The pipeline with which the engine draws casters: positions, and the library's matrix as a uniform buffer. */
static void make_pipeline(const char *file, VkBuffer projections, VkFormat depth_format) {
    static uint32_t words[16384];
    FILE *stream = fopen(file, "rb");
    size_t count;
    CHECK(stream != NULL);
    count = fread(words, sizeof *words, 16384, stream);
    fclose(stream);
    VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = count * 4, .pCode = words};
    VkShaderModule module;
    VK(vkCreateShaderModule(engine.device, &code, NULL, &module));
    VkDescriptorSetLayoutBinding binding = {.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, .descriptorCount = 1,
                                            .stageFlags = VK_SHADER_STAGE_VERTEX_BIT};
    VkDescriptorSetLayoutCreateInfo bindings = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 1,
                                                .pBindings = &binding};
    VK(vkCreateDescriptorSetLayout(engine.device, &bindings, NULL, &engine.set_layout));
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 1,
                                       .pPoolSizes = &size};
    VK(vkCreateDescriptorPool(engine.device, &pool, NULL, &engine.set_pool));
    VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, .descriptorPool = engine.set_pool,
                                       .descriptorSetCount = 1, .pSetLayouts = &engine.set_layout};
    VK(vkAllocateDescriptorSets(engine.device, &set, &engine.set));
    VkDescriptorBufferInfo range = {projections, 0, 64};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, .dstSet = engine.set, .descriptorCount = 1,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, .pBufferInfo = &range};
    vkUpdateDescriptorSets(engine.device, 1, &write, 0, NULL);
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1,
                                         .pSetLayouts = &engine.set_layout};
    VK(vkCreatePipelineLayout(engine.device, &layout, NULL, &engine.layout));
    VkPipelineShaderStageCreateInfo stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                             .stage = VK_SHADER_STAGE_VERTEX_BIT, .module = module, .pName = "main"};
    VkVertexInputBindingDescription vertices = {0, 12, VK_VERTEX_INPUT_RATE_VERTEX};
    VkVertexInputAttributeDescription position = {0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
    VkPipelineVertexInputStateCreateInfo input = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                                  .vertexBindingDescriptionCount = 1, .pVertexBindingDescriptions = &vertices,
                                                  .vertexAttributeDescriptionCount = 1, .pVertexAttributeDescriptions = &position};
    VkPipelineInputAssemblyStateCreateInfo assembly = {.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
                                                       .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkPipelineViewportStateCreateInfo viewport = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                  .viewportCount = 1, .scissorCount = 1};
    VkPipelineRasterizationStateCreateInfo raster = {.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    VkPipelineMultisampleStateCreateInfo samples = {.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo depth = {.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                   .depthTestEnable = VK_TRUE, .depthWriteEnable = VK_TRUE,
                                                   .depthCompareOp = VK_COMPARE_OP_GREATER};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic = {.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, .dynamicStateCount = 2,
                                                .pDynamicStates = states};
    VkPipelineRenderingCreateInfo rendering = {.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO, .depthAttachmentFormat = depth_format};
    VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, .pNext = &rendering, .stageCount = 1, .pStages = &stage,
        .pVertexInputState = &input, .pInputAssemblyState = &assembly, .pViewportState = &viewport, .pRasterizationState = &raster,
        .pMultisampleState = &samples, .pDepthStencilState = &depth, .pDynamicState = &dynamic, .layout = engine.layout};
    VK(vkCreateGraphicsPipelines(engine.device, VK_NULL_HANDLE, 1, &info, NULL, &engine.pipeline));
    vkDestroyShaderModule(engine.device, module, NULL);
}

/* Draws the plate, one unit higher than it is modelled: its own copy of the corners. */
static void draw(const hs_vk_view *view, void *user) {
    const VkDeviceSize offset = 4 * 12;
    const uint32_t dynamic = (uint32_t)view->offset;
    VkBuffer vertices = *(VkBuffer *)user;
    CHECK(view->type == HS_TYPE_VK_VIEW && view->map == MAP && view->offset == 256 * (VkDeviceSize)view->index);
    vkCmdBindPipeline(view->command_buffer, VK_PIPELINE_BIND_POINT_GRAPHICS, engine.pipeline);
    vkCmdBindDescriptorSets(view->command_buffer, VK_PIPELINE_BIND_POINT_GRAPHICS, engine.layout, 0, 1, &engine.set, 1, &dynamic);
    vkCmdBindVertexBuffers(view->command_buffer, 0, 1, &vertices, &offset);
    vkCmdBindIndexBuffer(view->command_buffer, engine.buffers[2], 12, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(view->command_buffer, 6, 1, 0, -4, 0);
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e6 + (double)time.tv_nsec * 1e-3;
}

static int by_size(const void *a, const void *b) {
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

int main(int argc, char **argv) {
    static float depths[PIXELS], normals[4 * PIXELS], raised[24], result[PIXELS];
    static double times[4096];
    const char *mode = argc > 1 ? argv[1] : "meshes";
    const int frames = argc > 2 ? atoi(argv[2]) : 4;
    const uint32_t split = getenv("HOST_OWNED_SPLIT") != NULL ? (uint32_t)atoi(getenv("HOST_OWNED_SPLIT")) : 1;
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkDeviceMemory memory;
    hs_vk_effect *effect = NULL;
    hs_context *context;
    int i, frame;
    CHECK(frames > 0 && frames <= 4096);
    create_instance();
    context = create_device();
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, .queueFamilyIndex = engine.family};
    VK(vkCreateCommandPool(engine.device, &pool, NULL, &engine.pool));
    VkCommandBufferAllocateInfo buffers = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = engine.pool,
                                           .commandBufferCount = FRAMES_IN_FLIGHT};
    VK(vkAllocateCommandBuffers(engine.device, &buffers, engine.commands));
    for (i = 0; i < FRAMES_IN_FLIGHT; ++i) {
        VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .flags = VK_FENCE_CREATE_SIGNALED_BIT};
        VK(vkCreateFence(engine.device, &fence, NULL, &engine.fences[i]));
    }

    /* What the engine draws in a frame. */
    engine.staging = make_buffer(NULL, 4 * MAP * MAP, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                 &engine.staging_memory);
    VK(vkMapMemory(engine.device, engine.staging_memory, 0, VK_WHOLE_SIZE, 0, (void **)&engine.staged));
    for (i = 0; i < PIXELS; ++i) {
        float x, z;
        const int height = hit(i, &x, &z);
        depths[i] = height < 0 ? 0 : NEAR / (EYE - (float)height);
        normals[4 * i + 1] = 1;
    }
    hs_vk_image surfaces[FRAMES_IN_FLIGHT], normal_images[FRAMES_IN_FLIGHT], results[FRAMES_IN_FLIGHT];
    hs_vk_slot slots[FRAMES_IN_FLIGHT];
    hs_vk_map map;
    hs_vk_image map_image = make_map(&map);
    for (i = 0; i < FRAMES_IN_FLIGHT; ++i) {
        surfaces[i] = make_image(VK_FORMAT_D32_SFLOAT, SIDE, sampled, depths, sizeof depths);
        normal_images[i] = make_image(VK_FORMAT_R32G32B32A32_SFLOAT, SIDE, sampled, normals, sizeof normals);
        results[i] = make_image(VK_FORMAT_R32_SFLOAT, SIDE, sampled | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, NULL, 0);
        results[i].final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        results[i].final_stage = VK_PIPELINE_STAGE_2_COPY_BIT;
        results[i].final_access = VK_ACCESS_2_TRANSFER_READ_BIT;
        slots[i] = (hs_vk_slot){.type = HS_TYPE_VK_SLOT, .size = sizeof *slots, .surface = &surfaces[i],
                                .normal = &normal_images[i], .visibility = &results[i]};
    }
    VkBuffer vertices = make_buffer(CORNERS, sizeof CORNERS, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &memory);
    VkBuffer indices = make_buffer(INDICES, sizeof INDICES, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT, &memory);
    memcpy(raised, CORNERS, sizeof raised);
    for (i = 0; i < 8; ++i) raised[3 * i + 1] += 1;
    VkBuffer drawn = make_buffer(raised, sizeof raised, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &memory);

    /* The effect. */
    hs_light light = {.type = HS_TYPE_LIGHT, .size = sizeof light, .shape = HS_LIGHT_RECT, .center = {0, LIGHT, 0},
                      .u = {0.5, 0, 0}, .v = {0, 0, 0.5}};
    hs_settings settings = {.type = HS_TYPE_SETTINGS, .size = sizeof settings};
    HS(hs_settings_default(HS_TECHNIQUE_PACKET_CONTOUR, &settings));
    settings.split = split;
    settings.map = MAP;
    hs_vk_effect_info info = {.type = HS_TYPE_VK_EFFECT_INFO, .size = sizeof info, .width = SIDE, .height = SIDE, .light = &light,
                              .settings = &settings, .surface = HS_VK_SURFACE_DEPTH, .normals = HS_VK_NORMALS_SIGNED,
                              .instance_max = 2, .vertex_max = 8, .triangle_max = 4};
    hs_vk_prepare_info prepare = {.type = HS_TYPE_VK_PREPARE_INFO, .size = sizeof prepare, .slots = slots, .slot_count = FRAMES_IN_FLIGHT};
    hs_vk_mesh meshes[2] = {{.type = HS_TYPE_VK_MESH, .size = sizeof *meshes, .vertices = vertices, .vertex_stride = 12,
                             .vertex_count = 4, .indices = indices, .index_type = VK_INDEX_TYPE_UINT16, .triangle_count = 2}};
    meshes[1] = meshes[0];
    meshes[1].vertex_offset = 4 * 12;
    hs_vk_instance instances[2] = {{.type = HS_TYPE_VK_INSTANCE, .size = sizeof *instances, .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}};
    instances[1] = instances[0];
    instances[1].mesh = 1;
    instances[1].transform[7] = 1;
    hs_vk_frame shown = {.type = HS_TYPE_VK_FRAME, .size = sizeof shown, .light = &light, .near_distance = 1.9f,
                         .world_from_clip = {1 / FOCAL, 0, 0, 0, 0, 0, 1 / FOCAL, 0, 0, EYE / NEAR, 0, 1 / NEAR, 0, -1, 0, 0},
                         .normal_to_world = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .background = 0.5f};
    if (strcmp(mode, "meshes") == 0) {
        info.casters = HS_VK_CASTERS_MESHES;
        prepare.meshes = meshes;
        prepare.mesh_count = 2;
        shown.instances = instances;
        shown.instance_count = 2;
    } else if (strcmp(mode, "callback") == 0) {
        info.casters = HS_VK_CASTERS_CALLBACK;
        shown.draw = draw;
        shown.draw_user = &drawn;
    } else {
        info.casters = HS_VK_CASTERS_MAPS;
        for (i = 0; i < FRAMES_IN_FLIGHT; ++i) {
            slots[i].maps = &map_image;
            slots[i].map_count = 1;
        }
        shown.maps = &map;
        shown.map_count = 1;
    }
    HS(hs_vk_effect_create(context, &info, &effect));
    CHECK(hs_vk_effect_record(effect, engine.commands[0], &shown) == HS_NOT_READY);
    HS(hs_vk_effect_prepare(effect, &prepare));
    hs_vk_effect_state state = {.type = HS_TYPE_VK_EFFECT_STATE, .size = sizeof state};
    HS(hs_vk_effect_describe(effect, &state));
    CHECK(state.prepared && state.memory_bytes > 0 && state.view_count == split * split);
    if (strcmp(mode, "callback") == 0) {
        CHECK(argc > 3 && state.projections != VK_NULL_HANDLE && state.projection_stride == 256);
        make_pipeline(argv[3], state.projections, VK_FORMAT_D32_SFLOAT);
    }

    /* Frames. */
    for (frame = 0; frame < frames; ++frame) {
        const unsigned turn = (unsigned)frame % FRAMES_IN_FLIGHT;
        VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {SIDE, SIDE, 1}};
        VkCommandBuffer commands = begin(turn);
        if (frame >= FRAMES_IN_FLIGHT) HS(hs_vk_effect_collect(effect, shown.serial + 1 - FRAMES_IN_FLIGHT));
        shown.serial = (uint64_t)frame + 1;
        shown.slot = turn;
        allocations = 0;
        times[frame] = now();
        HS(hs_vk_effect_record(effect, commands, &shown));
        times[frame] = now() - times[frame];
        CHECK(allocations == 0);
        if (frame + 1 == frames) {
            vkCmdCopyImageToBuffer(commands, results[turn].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, engine.staging, 1, &region);
        }
        submit(turn);
    }
    VK(vkQueueWaitIdle(engine.queue));
    memcpy(result, engine.staged, sizeof result);
    /* The maps are fitted to the plate, or else to all that could stand between the floor and the light. */
    check_visibility(result, shown.background, strcmp(mode, "callback") == 0 ? 0.036 : 0.007);
    qsort(times, (size_t)frames, sizeof *times, by_size);
    printf("%s: %u passes recorded in %.1f us (median of %d frames; %.1f to %.1f)\n", mode, state.pass_count, times[frames / 2],
           frames, times[0], times[frames - 1]);

    /* The engine's own order: the context may go first, the effect keeps it. */
    hs_context_destroy(context);
    hs_vk_effect_destroy(effect);
    CHECK(live_allocations == 0);
    vkDestroyPipeline(engine.device, engine.pipeline, NULL);
    vkDestroyPipelineLayout(engine.device, engine.layout, NULL);
    vkDestroyDescriptorPool(engine.device, engine.set_pool, NULL);
    vkDestroyDescriptorSetLayout(engine.device, engine.set_layout, NULL);
    while (engine.image_count > 0) vkDestroyImage(engine.device, engine.images[--engine.image_count], NULL);
    while (engine.buffer_count > 0) vkDestroyBuffer(engine.device, engine.buffers[--engine.buffer_count], NULL);
    while (engine.memory_count > 0) vkFreeMemory(engine.device, engine.memories[--engine.memory_count], NULL);
    for (i = 0; i < FRAMES_IN_FLIGHT; ++i) vkDestroyFence(engine.device, engine.fences[i], NULL);
    vkDestroyCommandPool(engine.device, engine.pool, NULL);
    vkDestroyDevice(engine.device, NULL);
    if (engine.messenger != VK_NULL_HANDLE) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(engine.instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(engine.instance, engine.messenger, NULL);
    }
    vkDestroyInstance(engine.instance, NULL);
    CHECK(engine.messages == 0);
    return 0;
}
