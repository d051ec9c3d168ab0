// What a game compiles to run a monitor and to log invalid samples.

#include ADAPTER

#include <stdio.h>

Monitor game_monitor;

void game_begin(void) {
    monitor_begin(&game_monitor);
}

bool game_step(const Signals *sample, Result *result) {
    return monitor_step(&game_monitor, sample, result);
}

void game_message(char *text, size_t size) {
    monitor_message(&game_monitor, text, size);
}
