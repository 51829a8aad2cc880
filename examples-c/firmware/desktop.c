/* The same program on a computer: its numbers are what the microcontroller's are compared with. */
#include "board.h"
#include <stdio.h>

void board_print(const char *text)
{
    fputs(text, stdout);
}

uint32_t board_ticks(void)
{
    return 0;
}

uint32_t board_stack(void)
{
    return 0;
}
