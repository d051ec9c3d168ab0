// Record two traces with the client in C: record FOLDER [NUMBER], where the number is recorded as a sample of its own.

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

#include <stdlib.h>

int main(int argc, char **argv) {
    static const tltl_signal_declaration signals[] = {{"near(a, b)", NULL, 0, 1}, {"seen", "bool", 0, 1}};
    tltl_recorder recorder;
    double values[2];
    int trace, step;
    if (argc < 2 || !tltl_recorder_init(&recorder, argv[1], signals, 2, argc > 2 ? 0 : 60)) return 2;
    if (argc > 2) {
        values[0] = atof(argv[2]);
        values[1] = 1;
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
