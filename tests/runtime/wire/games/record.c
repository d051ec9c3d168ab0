// Record two traces with the client in C: record FOLDER [NUMBER], where the number is recorded as a sample of its own.
// record FOLDER tape records the tape of the play of all clients.

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

#include <stdlib.h>
#include <string.h>

static int record_tape(const char *folder) {
    static const tltl_signal_declaration signals[] = {
        {"near(a, b)", NULL, 0, 1}, {"size", NULL, 0, 0}, {"seen", "bool", 0, 1}};
    static const double sizes[] = {5e-324, -0.0, 1e-300, 1e22, -123456.789, 0.1};
    tltl_recorder recorder;
    double values[3];
    char action[16];
    int step;
    tltl_recorder_init(&recorder, folder, signals, 3, 60);
    recorder.game = "walk";
    tltl_recorder_begin_scene(&recorder, "crypt", "v1", 7);
    values[0] = values[1] = values[2] = atof("nan");
    if (tltl_recorder_step(&recorder, "0", values)) return 1;
    for (step = 1; step <= 130; ++step) {
        values[0] = step / 3.0;
        values[1] = sizes[step % 6];
        values[2] = step == 130 ? 2 : 0;
        snprintf(action, sizeof action, "[%d, 1]", step % 3);
        if (!tltl_recorder_step(&recorder, action, values)) return 1;
    }
    tltl_recorder_begin(&recorder);
    if (!tltl_recorder_sample(&recorder, values) || tltl_recorder_step(&recorder, "1", values)) return 1;
    puts(recorder.error);
    tltl_recorder_begin_scene(&recorder, "crypt", NULL, 7);
    if (!tltl_recorder_step(&recorder, "1", values)) return 1;
    tltl_recorder_begin(&recorder);
    puts(recorder.path);
    return !tltl_recorder_end(&recorder);
}

int main(int argc, char **argv) {
    static const tltl_signal_declaration signals[] = {{"near(a, b)", NULL, 0, 1}, {"seen", "bool", 0, 1}};
    tltl_recorder recorder;
    double values[2];
    int trace, step;
    if (argc > 2 && strcmp(argv[2], "tape") == 0) return record_tape(argv[1]);
    if (argc < 2 || !tltl_recorder_init(&recorder, argv[1], signals, 2, argc > 2 ? 0 : 60)) return 2;
    if (argc > 2) {
        values[0] = atof(argv[2]);
        values[1] = 1;
        tltl_recorder_begin(&recorder);
        if (!tltl_recorder_sample(&recorder, values)) fprintf(stderr, "%s\n", recorder.error);
        return tltl_recorder_end(&recorder) && !recorder.error[0] ? 0 : 1;
    }
    for (trace = 0; trace < 2; ++trace) {
        tltl_recorder_begin(&recorder);
        for (step = 0; step < 4; ++step) {
            values[0] = step / 3.0;
            values[1] = trace == 0 && step == 3;
            tltl_recorder_sample(&recorder, values);
        }
    }
    puts(recorder.path);
    if (tltl_recorder_end(&recorder) && !recorder.error[0]) return 0;
    fprintf(stderr, "%s\n", recorder.error);
    return 1;
}
