// Makes a sample from a line of a trace.

static inline Signals sample_of(const double *numbers) {
    Signals sample;
@ASSIGNMENTS@
    return sample;
}
