// The game of the comment in tltl_client.h as an engine would play it, whose main loop is its own.

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

#include <string.h>

static tltl_client client;
static tltl_request request;
static int position, moves, direction, ticks_left, is_asked, has_quit;

static void answer(void) {
    double seen[1];
    seen[0] = position;
    tltl_begin_state(&client);
    tltl_signal(&client, "position", position);
    tltl_signal(&client, "moves", moves);
    tltl_signal_bool(&client, "at_goal", position == 10);
    tltl_observe(&client, seen, 1);
    tltl_send_state(&client, position == 10);
}

static void load(const char *scene) {
    if (scene && strcmp(scene, "crypt") == 0) {
        tltl_refuse(&client, "the scene `%s` cannot be loaded", scene);
        return;
    }
    position = moves = 0;
    answer();
}

// What the comment shows.
static void before_tick(void) {
    long long action = 1;
    if (ticks_left > 0 && --ticks_left > 0 && position != 10) return;
    if (is_asked) answer();
    is_asked = 0;
    while (!is_asked) {
        if (!tltl_next_request(&client, &request) || request.kind == TLTL_CLOSE) {
            has_quit = 1;
            return;
        }
        if (request.kind == TLTL_STEP) is_asked = 1;
        else if (request.kind == TLTL_RESET) load(request.scene);
        else tltl_refuse(&client, "this game does not know the request `%s`", request.name);
    }
    ticks_left = request.repeat;
    tltl_whole(request.action, &action);
    direction = (int)action - 1;
}

static void tick(void) {
    position += direction;
    ++moves;
}

int main(void) {
    static const tltl_signal_declaration signals[] = {
        {"position", NULL, 0, 10}, {"moves", NULL, 0, INFINITY}, {"at_goal", "bool", 0, 1}};
    static tltl_hello hello;
    hello.signals = signals;
    hello.signal_count = 3;
    hello.actions = TLTL_DISCRETE(3);
    hello.observation = TLTL_BOX(0, 10, "float32", 1);
    tltl_connect(&client, &hello, 0, NULL);
    while (!has_quit) {
        before_tick();
        if (!has_quit) tick();
    }
    if (client.error[0]) fprintf(stderr, "%s\n", client.error);
    tltl_close(&client);
    return client.error[0] != '\0';
}
