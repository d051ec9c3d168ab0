// From a line of a trace to a sample.

static inline Signals sample_of(const double *numbers) {
    Signals sample;
@GIVE@
    return sample;
}
