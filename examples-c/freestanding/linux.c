/* ../firmware/main.c as a program for x86-64 Linux without any C library: what a program has to bring along to use nekton. */
#include "../firmware/board.h"
#include <stddef.h>

int main(void);
void _start(void);
void *memcpy(void *to, const void *from, size_t n);
void *memmove(void *to, const void *from, size_t n);
void *memset(void *to, int byte, size_t n);
int memcmp(const void *a, const void *b, size_t n);
int bcmp(const void *a, const void *b, size_t n);

void *memcpy(void *to, const void *from, size_t n)
{
    unsigned char *t = to;
    const unsigned char *f = from;
    while (n-- > 0) {
        *t++ = *f++;
    }
    return to;
}

void *memmove(void *to, const void *from, size_t n)
{
    unsigned char *t = to;
    const unsigned char *f = from;
    if (t < f) {
        return memcpy(to, from, n);
    }
    while (n-- > 0) {
        t[n] = f[n];
    }
    return to;
}

void *memset(void *to, int byte, size_t n)
{
    unsigned char *t = to;
    while (n-- > 0) {
        *t++ = (unsigned char)byte;
    }
    return to;
}

int memcmp(const void *a, const void *b, size_t n)
{
    const unsigned char *x = a, *y = b;
    for (; n > 0; n--, x++, y++) {
        if (*x != *y) {
            return *x - *y;
        }
    }
    return 0;
}

int bcmp(const void *a, const void *b, size_t n)
{
    return memcmp(a, b, n);
}

static long system_call(long number, long a, long b, long c)
{
    long result;
    __asm__ volatile("syscall" : "=a"(result) : "a"(number), "D"(a), "S"(b), "d"(c) : "rcx", "r11", "memory");
    return result;
}

void board_print(const char *text)
{
    long length = 0;
    while (text[length] != '\0') {
        length++;
    }
    system_call(1, 1, (long)text, length); /* write to standard output */
}

uint32_t board_ticks(void)
{
    return 0;
}

uint32_t board_stack(void)
{
    return 0;
}

/* The stack of a new process is aligned otherwise than a function expects. */
__attribute__((force_align_arg_pointer, noreturn)) void _start(void)
{
    for (;;) {
        system_call(60, main(), 0, 0); /* exit */
    }
}
