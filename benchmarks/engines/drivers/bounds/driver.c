// Runs several monitors over traces; the traces of a monitor NAME are files NAME_0.txt, NAME_1.txt, ...
//
//     driver rows COUNT           for each trace, a row for each step of each monitor
//     driver time ROUNDS SECONDS  JSON lines: each monitor's steps per second of CPU time over its trace 0, in each round

#include "pass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

extern const Pass @NAMES@;
static const Pass *const passes[] = {@PLACES@};
enum { COUNT = sizeof passes / sizeof *passes };

static size_t load(const Pass *pass, int trace) {
    char path[100];
    snprintf(path, sizeof path, "%s_%d.txt", pass->name, trace);
    return pass->load(path);
}

static double seconds_of(const Pass *pass, long count) {
    const clock_t started = clock();
    for (long i = 0; i < count; i++) pass->run();
    return (double)(clock() - started) / CLOCKS_PER_SEC;
}

static void time_rounds(int rounds, double enough_s) {
    long repeats[COUNT];
    size_t samples = 0;
    for (int who = 0; who < COUNT; who++) {
        samples = load(passes[who], 0);
        for (repeats[who] = 1; seconds_of(passes[who], repeats[who]) < enough_s;) repeats[who] *= 2;
    }
    for (int round = 0; round < rounds; round++) {
        for (int who = 0; who < COUNT; who++) {
            const double rate = (double)samples * (double)repeats[who] / seconds_of(passes[who], repeats[who]);
            printf("%s\"%s\": %.0f", who ? ", " : "{", passes[who]->name, rate);
        }
        puts("}");
    }
}

int main(int argc, char **argv) {
    if (argc == 4 && strcmp(argv[1], "time") == 0) {
        time_rounds(atoi(argv[2]), atof(argv[3]));
        return 0;
    }
    if (argc != 3 || strcmp(argv[1], "rows") != 0) return 2;
    for (int trace = 0; trace < atoi(argv[2]); trace++) {
        for (int who = 0; who < COUNT; who++) {
            load(passes[who], trace);
            passes[who]->run();
            passes[who]->print();
        }
    }
    return 0;
}
