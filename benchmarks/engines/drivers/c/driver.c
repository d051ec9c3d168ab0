// Runs the generated and the handwritten monitor over the same traces, which have a line of numbers for each sample.
//
//     driver rows TRACE...             a row for each step, first of the generated, then of the handwritten one
//     driver time ROUNDS SECONDS TRACE   JSON lines: steps per second of CPU time in each round

#include "pass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const Pass *const passes[] = {&generated, &by_hand};

static size_t load(const char *path) {
    FILE *file = fopen(path, "r");
    double *numbers = NULL;
    size_t count = 0, room = 0;
    if (!file) exit(3);
    for (;;) {
        if (count == room) {
            room = room ? 2 * room : 1024;
            numbers = (double *)realloc(numbers, room * sizeof *numbers);
        }
        if (fscanf(file, "%lf", &numbers[count]) != 1) break;
        count++;
    }
    fclose(file);
    for (int who = 0; who < 2; who++) passes[who]->load(numbers, count / COLUMNS);
    free(numbers);
    return count / COLUMNS;
}

static double seconds_of(const Pass *pass, long passes_count) {
    const clock_t started = clock();
    for (long i = 0; i < passes_count; i++) pass->run();
    return (double)(clock() - started) / CLOCKS_PER_SEC;
}

static void time_rounds(int rounds, double enough_s, size_t samples) {
    long repeats[] = {1, 1};
    for (int who = 0; who < 2; who++) {
        while (seconds_of(passes[who], repeats[who]) < enough_s) repeats[who] *= 2;
    }
    for (int round = 0; round < rounds; round++) {
        double rates[2];
        for (int who = 0; who < 2; who++) {
            rates[who] = (double)samples * (double)repeats[who] / seconds_of(passes[who], repeats[who]);
        }
        printf("{\"generated\": %.0f, \"by_hand\": %.0f, ", rates[0], rates[1]);
        printf("\"rewards\": [%.17g, %.17g]}\n", generated.rewards(), by_hand.rewards());
    }
}

int main(int argc, char **argv) {
    if (argc == 5 && strcmp(argv[1], "time") == 0) {
        const size_t samples = load(argv[4]);
        time_rounds(atoi(argv[2]), atof(argv[3]), samples);
        return 0;
    }
    for (int i = 2; i < argc; i++) {
        load(argv[i]);
        for (int who = 0; who < 2; who++) {
            passes[who]->run();
            passes[who]->print();
        }
    }
    return 0;
}
