// The results of handwritten monitors of deadlines, and the counters behind them.  C99.

#ifndef BY_HAND_VERDICTS_H
#define BY_HAND_VERDICTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef enum { HOLDING, PENDING, VIOLATED } Verdict;

static const char *const verdict_names[] = {"holding", "pending", "violated"};

// How many samples a request has waited for its answer, itself included; 0 if no request is open.
static inline uint16_t waited(uint16_t waiting, bool request, bool answer, uint16_t most) {
    if (answer) return 0;
    if (waiting) return waiting < most ? (uint16_t)(waiting + 1) : most;
    return request;
}

// How many samples ago something was last true before this sample.
static inline uint16_t aged(uint16_t age, bool was_true, uint16_t most) {
    return was_true ? 1 : age < most ? (uint16_t)(age + 1) : most;
}

#endif
