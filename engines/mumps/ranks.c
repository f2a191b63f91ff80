/* Who a rank is, and how it speaks and ends. */
#include "shared.h"
#include <stdarg.h>
#include <unistd.h>

int rank, ranks;
const char *folder;

void die(const char *format, ...) {
    va_list list;
    fprintf(stderr, "stickslip-mumps, rank %d: ", rank);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
    fflush(stderr);
    MPI_Abort(MPI_COMM_WORLD, 1);
    _exit(1);
}

void *get(size_t count, size_t size) {
    void *memory = count ? calloc(count, size) : NULL;
    if (count && !memory) die("no memory for %zu numbers", count);
    return memory;
}

void answer(const char *format, ...) {
    va_list list;
    if (rank != 0) return;
    va_start(list, format);
    vprintf(format, list);
    va_end(list);
    putchar('\n');
    if (fflush(stdout)) die("the answer cannot be written");
}
