/* Counts the clock ticks of a factorization alone. */
#include "../../examples-c/firmware/board.h"
#include <stdbool.h>

uint32_t nekton_bench_multiply_adds(void);
int32_t nekton_bench_lu32(bool whole);
int32_t nekton_bench_lu64(bool whole);

#ifdef SINGLE
#define LU nekton_bench_lu32
#else
#define LU nekton_bench_lu64
#endif

static void print_count(const char *what, uint32_t n)
{
    char text[12], *p = text + sizeof text;
    *--p = '\0';
    do {
        *--p = (char)('0' + n % 10);
        n /= 10;
    } while (n > 0);
    board_print(what);
    board_print(p);
    board_print("\n");
}

int main(void)
{
    uint32_t fill, whole;
    int32_t failed;

    board_ticks();
    failed = LU(false);
    fill = board_ticks();
    failed += LU(true);
    whole = board_ticks();
    if (failed != 0) {
        return 1;
    }
    print_count("lu ticks ", whole - fill);
    print_count("multiply adds ", nekton_bench_multiply_adds());
    board_print("done\n");
    return 0;
}
