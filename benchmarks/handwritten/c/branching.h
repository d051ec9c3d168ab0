// Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps.

#ifndef BY_HAND_BRANCHING_H
#define BY_HAND_BRANCHING_H

#include "common.h"

enum { BRANCHING_TRAP = 2, BRANCHING_EXITS = 4, BRANCHING_GOAL = 5, BRANCHING_LIMIT = 600 };

typedef struct {
    double distance_s1;
    double distance_s2;
    double distance_s3;
    double distance_e_right;
    double distance_e_left;
    bool open_right;
    bool open_left;
    double health;
} Signals;

static inline const char *branching_refusal(const Signals *signals) {
    if (!isfinite(signals->distance_s1)) return "distance(s1) is not finite";
    if (!isfinite(signals->distance_s2)) return "distance(s2) is not finite";
    if (!isfinite(signals->distance_s3)) return "distance(s3) is not finite";
    if (!isfinite(signals->distance_e_right)) return "distance(e_right) is not finite";
    if (!isfinite(signals->distance_e_left)) return "distance(e_left) is not finite";
    if (!isfinite(signals->health)) return "health is not finite";
    return NULL;
}

// States 0, 1 and 3 wait for a switch, 4 for an exit, 5 is the goal, 2 is the trap.
// Returns false, and the state stays, where a signal is not finite.
static inline bool monitor_step(Monitor *monitor, const Signals *signals, Result *result) {
    static const char *const atoms[] = {"near(s1)", "near(s2)", "near(s3)"};
    static const char *const labels[] = {
        "F(near(s1) & X F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))))) & G alive",
        "F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left)))) & G alive",
        "false",
        "F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))) & G alive",
        "F(open_right & near(e_right) | open_left & near(e_left)) & G alive",
        "G alive",
    };
    static const char *const english[] = {
        "Reach near(s1), then near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
        "Reach near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
        "The spec is violated.",
        "Reach near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
        "Reach (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
        "Keep alive throughout.",
    };
    static const Verdict verdicts[] = {PENDING, PENDING, VIOLATED, PENDING, PENDING, HOLDING};
    static const int next[] = {1, 3, -1, 4};
    const char *const refusal = branching_refusal(signals);
    if (refusal) return monitor_refuse(monitor, refusal);

    const double alive = least(greatest(signals->health, 0.0), 1.0);
    int state = monitor->state;
    double robustness, progress = 0.0;
    result->limiting = NULL;
    if (state == BRANCHING_TRAP) {
        robustness = 1.0;
    } else if (alive <= 0.0) {
        state = BRANCHING_TRAP;
        robustness = 0.0;
    } else if (state == BRANCHING_GOAL) {
        robustness = alive;
        progress = 1.0;
    } else if (state == BRANCHING_EXITS) {
        const double right_open = signals->open_right ? 1.0 : -1.0;
        const double left_open = signals->open_left ? 1.0 : -1.0;
        const double right_near = near_to(signals->distance_e_right, monitor->level_size);
        const double left_near = near_to(signals->distance_e_left, monitor->level_size);
        const double right = least(right_open, right_near);
        const double left = least(left_open, left_near);
        const double nearest = greatest(right, left);
        if (nearest > 0.0) {
            state = BRANCHING_GOAL;
            robustness = least(nearest, alive);
            progress = 1.0;
        } else {
            robustness = least(-nearest, alive);
            progress = (4.0 + nearest) / 4.0;
            if (right >= left) {
                result->limiting = right_open <= right_near ? "open_right" : "near(e_right)";
            } else {
                result->limiting = left_open <= left_near ? "open_left" : "near(e_left)";
            }
        }
    } else {
        const double distances[] = {signals->distance_s1, signals->distance_s2, 0.0, signals->distance_s3};
        const int number = state == 3 ? 2 : state;
        const double closeness = near_to(distances[state], monitor->level_size);
        if (closeness > 0.0) {
            state = next[state];
            robustness = least(closeness, alive);
            progress = (number + 1.0) / 4.0;
        } else {
            robustness = least(-closeness, alive);
            progress = (number + 1.0 + closeness) / 4.0;
            result->limiting = atoms[number];
        }
    }

    monitor->steps++;
    const double best = greatest(monitor->progress, progress);
    double reward = 0.0;
    if (!monitor->done) {
        reward = best - monitor->progress - 1.0 / BRANCHING_LIMIT;
        if (state == BRANCHING_TRAP) reward -= (double)(BRANCHING_LIMIT - monitor->steps) / BRANCHING_LIMIT;
    }
    monitor->state = state;
    monitor->progress = best;
    monitor->done = monitor->done || state == BRANCHING_TRAP || state == BRANCHING_GOAL || monitor->steps >= BRANCHING_LIMIT;
    result->state = state;
    result->label = labels[state];
    result->label_english = english[state];
    result->verdict = verdicts[state];
    result->accepting = state == BRANCHING_GOAL;
    result->done = monitor->done;
    result->progress = best;
    result->reward = reward;
    result->robustness = robustness;
    monitor_tell(monitor, state == BRANCHING_TRAP, result);
    return true;
}

#endif
