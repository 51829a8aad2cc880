/* The swimmer of examples-c/firmware; counts the clock ticks of one evaluation of its equations of motion. */
#define main firmware_main
#include "../../examples-c/firmware/main.c"
#undef main

int main(void)
{
    NEKTON(method) method = {0};
    NEKTON(sim) *sim;
    nekton_diag diag;
    nekton_plan plan;
    real t, y[16], rate[16];
    uint32_t ticks;
    int32_t status = set_up();

    method.kind = NEKTON_METHOD_RK4;
    method.step = STEP;
    if (status >= 0) {
        status = NEKTON(sim_init)(sim_memory.bytes, sizeof sim_memory, model, &method, &sim, &diag);
    }
    if (status >= 0) {
        NEKTON(model_plan)(model, &plan);
        status = plan.state_len <= 16 ? NEKTON(sim_get_state)(sim, &t, y, plan.state_len) : NEKTON_E_LENGTH;
    }
    board_ticks();
    if (status >= 0) {
        status = NEKTON(sim_rhs)(sim, (real)0.3, y, rate, plan.state_len, &diag);
    }
    ticks = board_ticks();
    if (status < 0) {
        return failed("evaluation", status) != 0;
    }
    print_count("evaluation ticks ", ticks);
    board_print("\ndone\n");
    return 0;
}
