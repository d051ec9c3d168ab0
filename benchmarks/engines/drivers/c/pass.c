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

static void load(const double *numbers, size_t count) {
    monitor_begin(&monitor);
    samples = (Signals *)realloc(samples, count * sizeof *samples);
    results = (Result *)realloc(results, count * sizeof *results);
    length = count;
    for (size_t i = 0; i < count; i++) samples[i] = sample_of(numbers + i * COLUMNS);
}

static void run(void) {
    monitor_reset(&monitor);
    for (size_t i = 0; i < length; i++) {
        if (!monitor_step(&monitor, &samples[i], &results[i])) {
            fprintf(stderr, "%s refuses sample %d\n", TEXT(WHO), (int)i + 1);
            exit(1);
        }
    }
}

static double rewards(void) {
    double sum = 0.0;
    for (size_t i = 0; i < length; i++) sum += results[i].reward;
    return sum;
}

static void print(void) {
    for (size_t i = 0; i < length; i++) {
        const Result *result = &results[i];
        printf("%s\t%d\t%s\t%s\t", TEXT(WHO), result->state, result->label, verdict_name(result->verdict));
        printf("%s\t%s\t", result->accepting ? "true" : "false", result->done ? "true" : "false");
        printf("%.17g\t%.17g\t%.17g\t", result->progress, result->reward, result->robustness);
        const char *const names[] = {result->limiting, result->label_english, result->failed_clause, result->failed_atom};
        for (int place = 0; place < 4; place++) printf("%s\t", names[place] ? names[place] : "");
        if (result->failed_step) printf("%lld", (long long)result->failed_step);
        putchar('\n');
    }
}

const Pass WHO = {TEXT(WHO), load, run, rewards, print};
