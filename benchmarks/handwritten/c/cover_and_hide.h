// Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.  The three
// places exclude each other.

#ifndef BY_HAND_COVER_AND_HIDE_H
#define BY_HAND_COVER_AND_HIDE_H

#include "common.h"

enum { COVER_AND_HIDE_TRAP = 2, COVER_AND_HIDE_GOAL = 4, COVER_AND_HIDE_LIMIT = 400 };

typedef struct {
    double distance_s1;
    double distance_s2;
    double distance_exit;
    double health;
} Signals;

// States 0, 1 and 3 wait for a place, 4 is the goal, 2 is the trap.  False, and the state stays, where a signal is
// not finite or two places are near at once.
static inline bool monitor_step(Monitor *monitor, const Signals *signals, Result *result) {
    static const char *const atoms[] = {"near(s1)", "near(s2)", "near(exit)"};
    static const char *const labels[] = {
        "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
        "F(near(s2) & X F near(exit)) & G alive",
        "false",
        "F near(exit) & G alive",
        "G alive",
    };
    static const char *const english[] = {
        "Reach near(s1), then near(s2), then near(exit), and keep alive throughout.",
        "Reach near(s2), then near(exit), and keep alive throughout.",
        "The spec is violated.",
        "Reach near(exit), and keep alive throughout.",
        "Keep alive throughout.",
    };
    static const Verdict verdicts[] = {PENDING, PENDING, VIOLATED, PENDING, HOLDING};
    static const int place_of[] = {0, 1, -1, 2, -1};
    static const int next[] = {1, 3, -1, 4, -1};
    if (!isfinite(signals->distance_s1)) return monitor_refuse(monitor, "distance(s1) is not finite");
    if (!isfinite(signals->distance_s2)) return monitor_refuse(monitor, "distance(s2) is not finite");
    if (!isfinite(signals->distance_exit)) return monitor_refuse(monitor, "distance(exit) is not finite");
    if (!isfinite(signals->health)) return monitor_refuse(monitor, "health is not finite");

    const double alive = least(greatest(signals->health, 0.0), 1.0);
    const double near[] = {
        near_to(signals->distance_s1, monitor->level_size),
        near_to(signals->distance_s2, monitor->level_size),
        near_to(signals->distance_exit, monitor->level_size),
    };
    if ((near[0] > 0.0) + (near[1] > 0.0) + (near[2] > 0.0) > 1) {
        return monitor_refuse(monitor, "only one of near(s1), near(s2), near(exit) may hold at a time");
    }

    int state = monitor->state;
    double robustness, progress = 0.0;
    result->limiting = NULL;
    if (state == COVER_AND_HIDE_TRAP) {
        robustness = 1.0;
    } else if (alive <= 0.0) {
        state = COVER_AND_HIDE_TRAP;
        robustness = 0.0;
    } else if (state == COVER_AND_HIDE_GOAL) {
        robustness = alive;
        progress = 1.0;
    } else {
        const int place = place_of[state];
        const double here = near[place];
        if (here > 0.0) {
            state = next[state];
            robustness = least(here, alive);
            progress = (place + 1.0) / 3.0;
        } else {
            // At another place the player is certainly not here, because the places exclude each other.
            const double elsewhere = greatest(near[(place + 1) % 3], near[(place + 2) % 3]);
            robustness = least(greatest(-here, elsewhere), alive);
            progress = (place + 1.0 + here) / 3.0;
            result->limiting = atoms[place];
        }
    }

    monitor->steps++;
    const double best = greatest(monitor->progress, progress);
    double reward = 0.0;
    if (!monitor->done) {
        reward = best - monitor->progress - 1.0 / COVER_AND_HIDE_LIMIT;
        if (state == COVER_AND_HIDE_TRAP) {
            reward -= (double)(COVER_AND_HIDE_LIMIT - monitor->steps) / COVER_AND_HIDE_LIMIT;
        }
    }
    monitor->state = state;
    monitor->progress = best;
    monitor->done = monitor->done || state == COVER_AND_HIDE_TRAP || state == COVER_AND_HIDE_GOAL ||
                    monitor->steps >= COVER_AND_HIDE_LIMIT;
    result->state = state;
    result->label = labels[state];
    result->label_english = english[state];
    result->verdict = verdicts[state];
    result->accepting = state == COVER_AND_HIDE_GOAL;
    result->done = monitor->done;
    result->progress = best;
    result->reward = reward;
    result->robustness = robustness;
    monitor_tell(monitor, state == COVER_AND_HIDE_TRAP, result);
    return true;
}

#endif
