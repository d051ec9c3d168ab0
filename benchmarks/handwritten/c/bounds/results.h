// The result of the handwritten monitors that compute every field of a generated one.  C99.

#ifndef BY_HAND_RESULTS_H
#define BY_HAND_RESULTS_H

#include "verdicts.h"

typedef struct {
    int state;
    const char *label;
    Verdict verdict;
    bool accepting;
    bool done;
    double progress;
    double reward;
    double robustness;
    const char *limiting;    // NULL for none
} Result;

static const int states[] = {0, 1, 2};    // of the verdicts

// No progress and no reward can be earned: the rules are never satisfied for good.
static inline void result_set(Result *result, Verdict verdict, double robustness, const char *label) {
    result->state = states[verdict];
    result->label = verdict == VIOLATED ? "false" : label;
    result->verdict = verdict;
    result->accepting = verdict == HOLDING;
    result->done = verdict == VIOLATED;
    result->progress = 0.0;
    result->reward = 0.0;
    result->robustness = robustness;
    result->limiting = NULL;
}

static inline double greatest(double x, double y) {
    return x > y ? x : y;
}

// Positive once a request has waited for too long.
static inline double late(uint16_t waiting, double border) {
    return ((double)waiting - border) / border;
}

// Positive while something was true not long ago.
static inline double recent(uint16_t age, double border) {
    return (border - (double)age) / border;
}

static void print_result(const Result *result) {
    printf("%s\t%d\t%d\t", verdict_names[result->verdict], result->accepting, result->done);
    printf("%.17g\t%.17g\t%.17g\t", result->progress, result->reward, result->robustness);
    printf("%d\t%s\t%s\n", result->state, result->label, result->limiting ? result->limiting : "");
}

#endif
