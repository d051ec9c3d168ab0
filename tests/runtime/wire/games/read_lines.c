// Read each line of a file as a request, and print what the client of C understood: read_lines FILE [LOCALE]
//
// For each line, it prints `0` and the error, or `1` and the parts of the request, between tabs.  Texts are in
// hexadecimal digits, numbers as the client writes them.

#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NUMBERS = 64 };

static void print_text(const char *text) {
    putchar('\t');
    for (; text && *text; ++text) printf("%02x", (unsigned)(unsigned char)*text);
}

static void print_request(const tltl_request *request) {
    double numbers[MOST_NUMBERS];
    const size_t count = tltl_numbers(request->action, numbers, MOST_NUMBERS);
    size_t index;
    double last = 0;
    putchar('1');
    print_text(request->name);
    print_text(request->scene);
    print_text(request->variant);
    printf("\t%d\t%llu", request->has_seed, (unsigned long long)request->seed);
    printf("\t%d\t%lld\t", request->repeat, request->id);
    for (index = 0; index < count && index < MOST_NUMBERS; ++index) {
        char text[TLTL_NUMBER_SIZE_];
        tltl_number_text_(numbers[index], text);
        printf("%s%s", index ? " " : "", text);
    }
    if (request->action && request->action->type == TLTL_LIST)
        tltl_number(tltl_item(request->action, request->action->count - 1), &last);
    printf("\t%d\n", tltl_item(request->action, 1u << 20) == NULL && last == last);
}

// Send the line to a client over a pair of sockets, and let it read the request.
static int read_line(const char *line, size_t length) {
    int pair[2];
    tltl_client client;
    tltl_request request;
    tltl_init_(&client);
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair) != 0) return 0;
    client.connection = pair[0];
    if (!tltl_send_bytes_(pair[1], line, length)) return 0;
    close(pair[1]);
    if (tltl_next_request(&client, &request)) print_request(&request);
    else printf("0\t%s\n", client.error);
    tltl_close(&client);
    return 1;
}

int main(int argc, char **argv) {
    static char line[1 << 17];
    FILE *file = argc > 1 ? fopen(argv[1], "rb") : NULL;
    size_t length = 0;
    int letter;
    if (!file || (argc > 2 && !setlocale(LC_ALL, argv[2]))) return 2;
    while ((letter = fgetc(file)) != EOF) {
        if (length == sizeof line) return 2;
        line[length++] = (char)letter;
        if (letter == '\n') {
            if (!read_line(line, length)) return 2;
            length = 0;
        }
    }
    // A last line that has no end.
    if (length && !read_line(line, length)) return 2;
    fclose(file);
    return 0;
}
