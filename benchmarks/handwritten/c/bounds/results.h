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
    const char *label_english;
    long long failed_step;    // 0 for none
    const char *failed_clause;
    const char *failed_atom;
} Result;

typedef struct {
    const char *clause, *atom;
} Failure;

// The steps of a monitor so far, and what its trace fails at.
typedef struct {
    long long steps, failed_step;
    const Failure *failure;
} History;

static const int states[] = {0, 1, 2};    // of the verdicts

// No progress and no reward can be earned: the rules are never satisfied for good.
static inline void result_set(
    Result *result, Verdict verdict, double robustness, const char *label, const char *english, const History *history
) {
    result->state = states[verdict];
    result->label = verdict == VIOLATED ? "false" : label;
    result->verdict = verdict;
    result->accepting = verdict == HOLDING;
    result->done = verdict == VIOLATED;
    result->progress = 0.0;
    result->reward = 0.0;
    result->robustness = robustness;
    result->limiting = NULL;
    result->label_english = verdict == VIOLATED ? "The spec is violated." : english;
    result->failed_step = history->failed_step;
    result->failed_clause = history->failed_step ? history->failure->clause : NULL;
    result->failed_atom = history->failed_step ? history->failure->atom : NULL;
}

static inline void history_fail(History *history, const Failure *failure) {
    history->failed_step = history->steps;
    history->failure = failure;
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
    printf("%d\t%s\t%s\t", result->state, result->label, result->limiting ? result->limiting : "");
    printf("%s\t%lld\t%s\t", result->label_english, result->failed_step, result->failed_clause ? result->failed_clause : "");
    printf("%s\n", result->failed_atom ? result->failed_atom : "");
}

#endif
