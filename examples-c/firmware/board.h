/* What the program needs from the machine it runs on: board.c for a Cortex-M, desktop.c for a computer. */
#ifndef BOARD_H
#define BOARD_H
#include <stdint.h>

void board_print(const char *text);
/* Ticks of the core's clock since the last call (at most 2^24 - 1); 0 where there is no such clock. */
uint32_t board_ticks(void);
/* Bytes of stack used so far at most; 0 where that is not known. */
uint32_t board_stack(void);

#endif
