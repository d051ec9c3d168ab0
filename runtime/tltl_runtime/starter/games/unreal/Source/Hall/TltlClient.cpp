// The code of the client. It is a file of its own, because it includes the sockets of the system.

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"
