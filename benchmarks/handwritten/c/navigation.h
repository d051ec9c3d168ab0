// Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps.

#ifndef BY_HAND_NAVIGATION_H
#define BY_HAND_NAVIGATION_H

#include "common.h"

enum { NAVIGATION_GOAL = 3, NAVIGATION_LIMIT = 300 };

typedef struct {
    double distance_s1;
    double distance_s2;
    double distance_exit;
} Signals;

// The state is the number of marks that were reached in order.  False, and the state stays, where a signal is not
// finite.
static inline bool monitor_step(Monitor *monitor, const Signals *signals, Result *result) {
    static const char *const atoms[] = {"near(s1)", "near(s2)", "near(exit)"};
    static const char *const labels[] = {
        "F(near(s1) & X F(near(s2) & X F near(exit)))",
        "F(near(s2) & X F near(exit))",
        "F near(exit)",
        "true",
    };
    static const char *const english[] = {
        "Reach near(s1), then near(s2), then near(exit).",
        "Reach near(s2), then near(exit).",
        "Reach near(exit).",
        "Nothing remains to be done.",
    };
    const double distances[] = {signals->distance_s1, signals->distance_s2, signals->distance_exit};
    if (!isfinite(distances[0])) return monitor_refuse(monitor, "distance(s1) is not finite");
    if (!isfinite(distances[1])) return monitor_refuse(monitor, "distance(s2) is not finite");
    if (!isfinite(distances[2])) return monitor_refuse(monitor, "distance(exit) is not finite");

    int state = monitor->state;
    double robustness = 1.0, progress = 1.0;
    result->limiting = NULL;
    if (state < NAVIGATION_GOAL) {
        const double closeness = near_to(distances[state], monitor->level_size);
        if (closeness > 0.0) {
            state++;
            robustness = closeness;
            progress = state / 3.0;
        } else {
            robustness = -closeness;
            progress = (state + 1.0 + closeness) / 3.0;
            result->limiting = atoms[state];
        }
    }

    monitor->steps++;
    const double best = greatest(monitor->progress, progress);
    result->reward = monitor->done ? 0.0 : best - monitor->progress - 1.0 / NAVIGATION_LIMIT;
    monitor->state = state;
    monitor->progress = best;
    monitor->done = monitor->done || state == NAVIGATION_GOAL || monitor->steps >= NAVIGATION_LIMIT;
    result->state = state;
    result->label = labels[state];
    result->label_english = english[state];
    result->verdict = state == NAVIGATION_GOAL ? SATISFIED : PENDING;
    result->accepting = state == NAVIGATION_GOAL;
    result->done = monitor->done;
    result->progress = best;
    result->robustness = robustness;
    result->failed_clause = NULL;
    result->failed_atom = NULL;
    result->failed_step = 0;
    return true;
}

#endif
