/* Renders a shot file as it is and writes the raw visibility of its first light: SHOT OUTPUT. */
#include "check.h"

static unsigned messages;

static void count(uint32_t severity, const char *message, void *user) {
    (void)user;
    if (severity == HS_LOG_WARNING) {
        ++messages;
        fprintf(stderr, "%s\n", message);
    }
}

int main(int argc, char **argv) {
    hs_context *context = NULL;
    hs_shot *shot = NULL;
    hs_renderer *renderer = NULL;
    float *visibility;
    FILE *file;
    uint64_t pixels, said = 1;
    HEAD(hs_context_info, info, HS_TYPE_CONTEXT_INFO);
    HEAD(hs_shot_counts, counts, HS_TYPE_SHOT_COUNTS);
    CHECK(argc == 3);
    info.flags = HS_CONTEXT_VALIDATE;
    info.log = count;
    OK(hs_context_create(&info, &context));
    OK(hs_shot_load(context, argv[1], &shot));
    OK(hs_shot_describe(shot, &counts));
    CHECK(counts.lights == 1);
    OK(hs_renderer_create(shot, NULL, &renderer));
    /* Any order of destruction: what is still needed stays. */
    hs_shot_destroy(shot);
    pixels = (uint64_t)counts.width * counts.height;
    visibility = malloc(pixels * sizeof *visibility);
    CHECK(visibility != NULL);
    CHECK(hs_renderer_visibility(renderer, 0, visibility, pixels) == HS_NOT_READY);
    OK(hs_renderer_render(renderer));
    OK(hs_renderer_visibility(renderer, 0, visibility, pixels));
    OK(hs_context_validation_messages(context, &said));
    CHECK(said == 0);
    hs_context_destroy(context);
    file = fopen(argv[2], "wb");
    CHECK(file != NULL);
    CHECK(fwrite(visibility, sizeof *visibility, pixels, file) == pixels);
    CHECK(fclose(file) == 0);
    hs_renderer_destroy(renderer);
    CHECK(messages == 0);
    free(visibility);
    return 0;
}
