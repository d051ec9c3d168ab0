// The handwritten monitor.

#include "@BY_HAND@/@SPEC@.h"

#define monitor_begin(monitor) monitor_init(monitor, 20.0)
#define monitor_message(monitor, text, size) snprintf(text, size, "%s", (monitor)->problem)
