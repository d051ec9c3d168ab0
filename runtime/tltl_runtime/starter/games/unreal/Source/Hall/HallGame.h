// The hall: fetch the key, then leave by the door. Spikes end the game.
//
// A level is a text: `#` is a wall, `K` the key, `D` the door, `^` spikes. The player begins on a dot. This file is C99
// and C++11, and needs no Unreal, so that the game also runs without it.

#ifndef HALL_GAME_H
#define HALL_GAME_H

#include "tltl_client.h"

#include <stdio.h>
#include <string.h>

enum { HALL_MOST_CELLS = 64, HALL_MOVES = 4 };

typedef struct {
    char rows[HALL_MOST_CELLS][HALL_MOST_CELLS];  // from north to south
    int row_count, x, y, has_key;                 // y counts from the south
} hall_game;

static const tltl_signal_declaration hall_signals[] = {
    {"has_key", "bool", 0, 1}, {"at_door", "bool", 0, 1}, {"on_spikes", "bool", 0, 1}};
static const char *const hall_scenes[] = {"hall"};

static char hall_mark(const hall_game *hall, int x, int y) { return hall->rows[hall->row_count - 1 - y][x]; }

// Read the level, and stand on its start with this number.  0 if there is no such file, or no start in it.
static int hall_begin(hall_game *hall, const char *path, uint64_t number) {
    FILE *file = fopen(path, "r");
    int x, y, count = 0, wanted;
    if (!file) return 0;
    hall->row_count = 0;
    while (hall->row_count < HALL_MOST_CELLS && fscanf(file, "%63s", hall->rows[hall->row_count]) == 1) ++hall->row_count;
    fclose(file);
    for (y = 0; y < hall->row_count; ++y)
        for (x = 0; hall_mark(hall, x, y); ++x) count += hall_mark(hall, x, y) == '.';
    if (count == 0) return 0;
    wanted = (int)(number % (uint64_t)count);
    for (y = 0; y < hall->row_count; ++y)
        for (x = 0; hall_mark(hall, x, y); ++x)
            if (hall_mark(hall, x, y) == '.' && wanted-- == 0) {
                hall->x = x;
                hall->y = y;
            }
    hall->has_key = 0;
    return 1;
}

// Play one tick.
static void hall_move(hall_game *hall, int action) {
    static const int right[HALL_MOVES] = {0, 0, -1, 1}, up[HALL_MOVES] = {1, -1, 0, 0};  // up, down, left, right
    const int x = hall->x + right[action], y = hall->y + up[action];
    if (hall_mark(hall, x, y) != '#') {
        hall->x = x;
        hall->y = y;
    }
    if (hall_mark(hall, hall->x, hall->y) == 'K') hall->has_key = 1;
}

// What tltlc asks for ---------------------------------------------------------------------------------------------

static tltl_outcome hall_reset(void *self, tltl_client *client, const tltl_request *request) {
    if (request->scene && strcmp(request->scene, "hall") != 0)
        return tltl_refuse(client, "there is no scene `%s`", request->scene);
    if (strcmp(request->variant, "v0") != 0) return tltl_refuse(client, "there is no variant `%s`", request->variant);
    if (!hall_begin((hall_game *)self, "levels/hall.txt", request->seed))
        return tltl_refuse(client, "there is no level in levels/hall.txt");
    return TLTL_GOES_ON;
}

static tltl_outcome hall_step(void *self, tltl_client *client, const tltl_request *request) {
    hall_game *hall = (hall_game *)self;
    long long action;
    if (!tltl_whole(request->action, &action) || action < 0 || action >= HALL_MOVES)
        return tltl_refuse(client, "an action is 0, 1, 2 or 3");
    if (hall->row_count == 0) return tltl_refuse(client, "there is no episode");
    hall_move(hall, (int)action);
    return hall_mark(hall, hall->x, hall->y) == '^' ? TLTL_ENDED : TLTL_GOES_ON;
}

static void hall_describe(void *self, tltl_client *client) {
    const hall_game *hall = (const hall_game *)self;
    const char here = hall_mark(hall, hall->x, hall->y);
    double seen[2];
    int x, y;
    seen[0] = hall->x;
    seen[1] = hall->y;
    tltl_signal_bool(client, "has_key", hall->has_key);
    tltl_signal_bool(client, "at_door", here == 'D');
    tltl_signal_bool(client, "on_spikes", here == '^');
    tltl_observe(client, seen, 2);
    tltl_position(client, "player", hall->x + 0.5, hall->y + 0.5);
    for (y = 0; y < hall->row_count; ++y)
        for (x = 0; hall_mark(hall, x, y); ++x) {
            const char mark = hall_mark(hall, x, y);
            const char *name = mark == 'K' ? "key" : mark == 'D' ? "door" : mark == '^' ? "spikes" : NULL;
            if (name) tltl_position(client, name, x + 0.5, y + 0.5);
        }
    tltl_cause(client, here == '^' ? "spikes" : NULL);
}

// Play for tltlc until it closes the connection; return the exit status.
static int hall_play(void) {
    static hall_game hall;
    static tltl_game game;
    game.hello.name = "hall";
    game.hello.clock_hz = 10;
    game.hello.signals = hall_signals;
    game.hello.signal_count = 3;
    game.hello.actions = TLTL_DISCRETE(4);
    game.hello.observation = "{\"type\": \"multi_discrete\", \"nvec\": [9, 6]}";  // the size of each level, in cells
    game.hello.scenes = hall_scenes;
    game.hello.scene_count = 1;
    game.hello.capabilities = TLTL_SEED | TLTL_POSITIONS;
    game.self = &hall;
    game.reset = hall_reset;
    game.step = hall_step;
    game.describe = hall_describe;
    return tltl_play(&game);
}

#endif
