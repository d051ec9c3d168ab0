// The game without Unreal: `cc -O2 -o hall -I Source/Hall Headless/hall_main.c -lm`
//
// tltlc plays if it has started the game. Otherwise a person does: w, a, s or d and Enter for each move, or several at
// once; q ends. Each walk becomes a trace and a tape in the folder `traces`.

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

#include "HallGame.h"

#include <stdlib.h>
#include <time.h>

static int play_by_hand(void) {
    static const char keys[] = "wsad";  // in the order of the moves
    static hall_game hall;
    static tltl_recorder recorder;
    const long long seed = (long long)time(NULL);
    char key;
    int y;
    if (!hall_begin(&hall, "levels/hall.txt", (uint64_t)seed)) return 1;
    if (!tltl_recorder_init(&recorder, "traces", hall_signals, 3, 10)) return 1;
    recorder.game = "hall";
    do {
        for (y = hall.row_count - 1; y >= 0; --y) {
            const char *row = hall.rows[hall.row_count - 1 - y];
            if (y == hall.y) printf("%.*s@%s\n", hall.x, row, row + hall.x + 1);
            else printf("%s\n", row);
        }
        printf(hall.has_key ? "You have the key.\n" : "Fetch the key K.\n");
        while (scanf("%c", &key) == 1 && key != '\n' && key != 'q')
            if (strchr(keys, key)) {
                const int move = (int)(strchr(keys, key) - keys);
                const char action[] = {(char)('0' + move), '\0'};  // as JSON
                double values[3];
                hall_move(&hall, move);
                values[0] = hall.has_key;
                values[1] = hall_mark(&hall, hall.x, hall.y) == 'D';
                values[2] = hall_mark(&hall, hall.x, hall.y) == '^';
                if (!recorder.samples) tltl_recorder_begin_scene(&recorder, "hall", "v0", seed);
                if (!tltl_recorder_step(&recorder, action, values)) {
                    fprintf(stderr, "%s\n", recorder.error);
                    return 1;
                }
            }
    } while (!feof(stdin) && key != 'q' && hall_mark(&hall, hall.x, hall.y) != '^');
    tltl_recorder_end(&recorder);
    return 0;
}

int main(void) {
    return getenv("TLTL_PORT") ? hall_play() : play_by_hand();
}
