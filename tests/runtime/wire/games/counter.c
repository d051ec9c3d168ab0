// The game of the conformance script in C and C++; `tests/runtime/wire/conversation.py` describes it.
//
// Usage: counter [--listen PORT]

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_SNAPSHOTS = 100 };

typedef struct {
    int goal, has_trap, position, moves;  // a goal of 0 stands for a snapshot that was released
} counter_state;

typedef struct {
    counter_state now, snapshots[MOST_SNAPSHOTS];
    int snapshot_count;
} counter;

static int is_at_goal(const counter_state *state) { return state->position >= state->goal; }

static int is_trapped(const counter_state *state) { return state->has_trap && state->position == 0; }

static tltl_outcome outcome(const counter_state *state) {
    return is_at_goal(state) || is_trapped(state) ? TLTL_ENDED : TLTL_GOES_ON;
}

// Begin at 1 + seed mod 4.
static tltl_outcome reset(void *self, tltl_client *client, const tltl_request *request) {
    counter_state *now = &((counter *)self)->now;
    const char *scene = request->scene ? request->scene : "short";
    if (strcmp(scene, "short") != 0 && strcmp(scene, "long") != 0)
        return tltl_refuse(client, "there is no scene `%s`", scene);
    if (strcmp(request->variant, "v0") != 0 && strcmp(request->variant, "trap") != 0)
        return tltl_refuse(client, "there is no variant `%s`", request->variant);
    now->goal = strcmp(scene, "short") == 0 ? 5 : 10;
    now->has_trap = strcmp(request->variant, "trap") == 0;
    now->position = 1 + (int)(request->seed % 4);
    now->moves = 0;
    return TLTL_GOES_ON;
}

// Move left (0), stay (1) or move right (2).
static tltl_outcome step(void *self, tltl_client *client, const tltl_request *request) {
    counter_state *now = &((counter *)self)->now;
    long long action;
    if (!tltl_whole(request->action, &action) || action < 0 || action > 2)
        return tltl_refuse(client, "an action is 0, 1 or 2");
    now->position += (int)action - 1;
    if (now->position < 0) now->position = 0;
    if (now->position > 10) now->position = 10;
    ++now->moves;
    return outcome(now);
}

static void describe(void *self, tltl_client *client) {
    const counter_state *now = &((counter *)self)->now;
    double seen[1];
    seen[0] = now->position;
    tltl_signal(client, "position", now->position);
    tltl_signal(client, "moves", now->moves);
    tltl_signal_bool(client, "at_goal", is_at_goal(now));
    tltl_observe(client, seen, 1);
    tltl_position(client, "player", now->position, 0);
    tltl_cause(client, is_at_goal(now) ? "goal" : is_trapped(now) ? "trap" : NULL);
}

// Keep the state; the ids are 1, 2, 3 and so on.
static long long snapshot(void *self) {
    counter *game = (counter *)self;
    if (game->snapshot_count == MOST_SNAPSHOTS) return -1;
    game->snapshots[game->snapshot_count] = game->now;
    return ++game->snapshot_count;
}

static int is_kept(const counter *game, long long id) {
    return id >= 1 && id <= game->snapshot_count && game->snapshots[id - 1].goal > 0;
}

static int release(void *self, long long id) {
    counter *game = (counter *)self;
    if (!is_kept(game, id)) return 0;
    game->snapshots[id - 1].goal = 0;
    return 1;
}

static tltl_outcome restore(void *self, tltl_client *client, const tltl_request *request) {
    counter *game = (counter *)self;
    if (!is_kept(game, request->id))
        return tltl_refuse(client, "there is no snapshot %lld", request->id);
    game->now = game->snapshots[request->id - 1];
    return outcome(&game->now);
}

// Draw a row of 11 black pixels; that of the player is white.
static int screenshot(void *self, tltl_client *client) {
    unsigned char pixels[33] = {0};
    memset(pixels + 3 * ((counter *)self)->now.position, 255, 3);
    return tltl_send_picture(client, pixels, 1, 11, 3);
}

// What maps show: the edges of the row, the goal, and the trap if there is one.
static void outline(void *self, tltl_client *client) {
    static const double bounds[] = {-1, -2, 11, 3}, edges[] = {-1, -1, -0.5, 2, 10.5, -1, 11, 2};
    static const double trap[] = {-0.5, -1, 0.5, -1, 0, 2}, extent[] = {-0.5, -1, 10.5, 2};
    static const unsigned char white[] = {255, 255, 255};
    const counter_state *now = &((counter *)self)->now;
    double goal[] = {0, -1, 10.5, 2};
    if (now->has_trap && now->goal == 5) {
        tltl_refuse(client, "there is no outline of the trap in `short`");
        return;
    }
    goal[0] = now->goal - 0.5;
    tltl_bounds(client, bounds, 2);
    tltl_boxes(client, "edge", edges, 2, 2);
    if (now->has_trap) tltl_polygon(client, "trap", trap, 3);
    tltl_region(client, "goal", goal, 2);
    tltl_image(client, white, 1, 1, 3, extent);
}

int main(int argc, char **argv) {
    static const tltl_signal_declaration signals[] = {
        {"position", NULL, 0, 10}, {"moves", NULL, 0, INFINITY}, {"at_goal", "bool", 0, 1}};
    static const tltl_param params[] = {{"goal", 10}};
    static const char *const scenes[] = {"short", "long"};
    static counter self;
    static tltl_game game;
    game.hello.name = "counter";
    game.hello.clock_hz = 10;
    game.hello.signals = signals;
    game.hello.signal_count = 3;
    game.hello.params = params;
    game.hello.param_count = 1;
    game.hello.actions = TLTL_DISCRETE(3);
    game.hello.observation = TLTL_BOX(0, 10, "float32", 1);
    game.hello.scenes = scenes;
    game.hello.scene_count = 2;
    game.hello.capabilities = TLTL_SEED | TLTL_POSITIONS;
    game.self = &self;
    game.reset = reset;
    game.step = step;
    game.describe = describe;
    game.snapshot = snapshot;
    game.restore = restore;
    game.release = release;
    game.screenshot = screenshot;
    game.outline = outline;
    self.now.goal = 5;
    self.now.position = 1;
    if (argc == 3 && strcmp(argv[1], "--listen") == 0) {
        const tltl_hello hello = tltl_game_hello(&game);
        for (;;) {
            tltl_client client;
            tltl_listen(&client, &hello, atoi(argv[2]), NULL);
            if (tltl_serve(&game, &client) != 0) return 1;
        }
    }
    return tltl_play(&game);
}
