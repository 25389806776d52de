/* Eight threads with a context each give the same image as one alone. */
#include <pthread.h>

#include "check.h"

enum { THREADS = 8, SIDE = 16, PIXELS = SIDE * SIDE };

static void *work(void *place) {
    float *visibility = place;
    hs_context *context = make_context(0);
    hs_shot *shot = make_shot(context, SIDE, 0.4);
    hs_renderer *renderer = NULL;
    char text[256];
    OK(hs_renderer_create(shot, NULL, &renderer));
    OK(hs_renderer_render(renderer));
    OK(hs_renderer_visibility(renderer, 0, visibility, PIXELS));
    CHECK(hs_renderer_visibility(renderer, 9, visibility, PIXELS) == HS_INVALID_ARGUMENT);
    CHECK(hs_last_error(context, text, sizeof text) > 1 && strstr(text, "9") != NULL);
    hs_context_destroy(context);
    hs_renderer_destroy(renderer);
    hs_shot_destroy(shot);
    return NULL;
}

int main(void) {
    static float alone[PIXELS], together[THREADS][PIXELS];
    pthread_t threads[THREADS];
    int i;
    work(alone);
    for (i = 0; i < THREADS; ++i) CHECK(pthread_create(&threads[i], NULL, work, together[i]) == 0);
    for (i = 0; i < THREADS; ++i) {
        CHECK(pthread_join(threads[i], NULL) == 0);
        CHECK(memcmp(together[i], alone, sizeof alone) == 0);
    }
    return 0;
}
