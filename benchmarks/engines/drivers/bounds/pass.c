// Passes of one monitor over a trace.  Compiled for each monitor by itself: ADAPTER is the header that gives it the names
// used here, WHO its name, COLUMNS the number of signals.  All results are written to memory, so that no field of them
// is left out.

#include ADAPTER
#include "pass.h"
#include "sample.h"

#include <stdio.h>
#include <stdlib.h>

#define TEXT_(word) #word
#define TEXT(word) TEXT_(word)

static Monitor monitor;
static Signals *samples;
static Result *results;
static size_t length;

static size_t load(const char *path) {
    FILE *file = fopen(path, "r");
    double numbers[COLUMNS];
    size_t room = 1024;
    if (!file) exit(3);
    monitor_begin(&monitor);
    samples = (Signals *)realloc(samples, room * sizeof *samples);
    for (length = 0;; length++) {
        for (int place = 0; place < COLUMNS; place++) {
            if (fscanf(file, "%lf", &numbers[place]) == 1) continue;
            fclose(file);
            results = (Result *)realloc(results, (length + 1) * sizeof *results);
            return length;
        }
        if (length == room) samples = (Signals *)realloc(samples, (room *= 2) * sizeof *samples);
        samples[length] = sample_of(numbers);
    }
}

static void run(void) {
    monitor_reset(&monitor);
    for (size_t i = 0; i < length; i++) {
        if (!monitor_step(&monitor, &samples[i], &results[i])) exit(1);
    }
}

static void print(void) {
    for (size_t i = 0; i < length; i++) {
        printf("%s\t", TEXT(WHO));
        print_result(&results[i]);
    }
}

const Pass WHO = {TEXT(WHO), load, run, print};
