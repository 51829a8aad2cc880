/* Start of a Cortex-M4F or M7, and output by semihosting (a debugger, or QEMU). */
#include "board.h"

#define CPACR (*(volatile uint32_t *)0xE000ED88u)
#define SYSTICK_CONTROL (*(volatile uint32_t *)0xE000E010u)
#define SYSTICK_RELOAD (*(volatile uint32_t *)0xE000E014u)
#define SYSTICK_VALUE (*(volatile uint32_t *)0xE000E018u)
#define PAINT 0x5AFE5AFEu

extern uint32_t data_in_flash[], data_begin[], data_end[], bss_begin[], bss_end[], stack_bottom[], stack_top[];
int main(void);
void start(void);

static void semihosting(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void stop(uint32_t code)
{
    const uint32_t exit_status[2] = {0x20026u, code};
    semihosting(0x20u, exit_status);
    for (;;) {
    }
}

void board_print(const char *text)
{
    semihosting(0x04u, text);
}

uint32_t board_ticks(void)
{
    static uint32_t last;
    uint32_t now = SYSTICK_VALUE, passed = (last - now) & 0xFFFFFFu; /* it counts down */
    last = now;
    return passed;
}

uint32_t board_stack(void)
{
    const uint32_t *p = stack_bottom;
    while (p < stack_top && *p == PAINT) {
        p++;
    }
    return (uint32_t)((const char *)stack_top - (const char *)p);
}

void start(void)
{
    uint32_t *to, *frame = __builtin_frame_address(0);
    const uint32_t *from = data_in_flash;
    CPACR |= 0xFu << 20; /* floating-point unit on */
    __asm__ volatile("dsb\n isb");
    for (to = data_begin; to < data_end;) {
        *to++ = *from++;
    }
    for (to = bss_begin; to < bss_end;) {
        *to++ = 0;
    }
    for (to = stack_bottom; to < frame - 32;) { /* the part in use stays as it is */
        *to++ = PAINT;
    }
    SYSTICK_RELOAD = 0xFFFFFFu;
    SYSTICK_VALUE = 0;
    SYSTICK_CONTROL = 5; /* on, core clock, no interrupt */
    stop((uint32_t)main());
}

static void fault(void)
{
    board_print("fault\n");
    stop(99);
}

typedef void (*handler)(void);
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    handler handlers[15];
} vectors = {stack_top, {start, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, fault, 0, fault, fault}};
