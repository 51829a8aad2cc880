// Every member function of the wrapper compiles in both precisions, with and without exceptions; objects move, refuse and end
// as documented.
#include "nekton.hpp"
#include <cstdint>
#include <cstdio>
#include <type_traits>
#include <utility>
#include <vector>

template class nekton::BasicModel<double>;
template class nekton::BasicModel<float>;
template class nekton::BasicSim<double>;
template class nekton::BasicSim<float>;
template class nekton::Span<double>;

static_assert(!std::is_copy_constructible_v<nekton::Model> && !std::is_copy_assignable_v<nekton::Model>);
static_assert(!std::is_copy_constructible_v<nekton::Sim> && !std::is_copy_assignable_v<nekton::Sim>);
static_assert(std::is_nothrow_move_constructible_v<nekton::Model> && std::is_nothrow_move_assignable_v<nekton::Sim>);
static_assert(!std::is_constructible_v<nekton::Body, nekton::Link &&>, "a body must not point to a link that is gone");

#define CHECK(x)                                                                                                               \
    do {                                                                                                                       \
        if (!(x)) {                                                                                                            \
            std::fprintf(stderr, "line %d: %s\n", __LINE__, #x);                                                               \
            return 1;                                                                                                          \
        }                                                                                                                      \
    } while (0)

template <class R> int run()
{
    nekton::BasicLink<R> link = nekton::BasicLink<R>::ellipse(R(0.5), R(0.2));
    nekton::BasicBody<R> body(link);
    body.velocity[0] = R(0.3);
    body.velocity[2] = R(0.2);
    const nekton::BasicScene<R> scene(body);
    const auto method = nekton::BasicMethod<R>::rk4(R(0.1));
    const auto careful = nekton::BasicMethod<R>::adams(R(1e-3), R(0.25), R(0.125));
    CHECK(careful.kind == NEKTON_METHOD_ADAMS && careful.relative == R(1e-3) && careful.absolute == R(1e-3));
    CHECK(careful.max_step == R(0.25) && careful.first_step == R(0.125) && careful.struct_size == sizeof careful);
    CHECK(method.kind == NEKTON_METHOD_RK4 && method.max_step == R(0) && method.first_step == R(0));

    nekton::BasicModel<R> model(scene);
    nekton::BasicSim<R> sim(model, method);
    CHECK(model && sim && model.plan().links == 1);
    // Both move; the simulation goes on.
    nekton::BasicModel<R> moved_model = std::move(model);
    nekton::BasicSim<R> moved;
    moved = std::move(sim);
    CHECK(!model && !sim && moved && moved_model);
    CHECK(moved.advance(R(1)) == NEKTON_OK && moved.time() == R(1));
    CHECK(moved.model() == moved_model.get());
    // A copy goes on exactly alike.
    nekton::BasicSim<R> other(moved_model, method);
    CHECK(other.copy_from(moved) == NEKTON_OK);
    R q[3], p[3];
    CHECK(moved.step() == NEKTON_OK && other.step() == NEKTON_OK);
    CHECK(moved.positions(q) == NEKTON_OK && other.positions(p) == NEKTON_OK);
    CHECK(q[0] == p[0] && q[1] == p[1] && q[2] == p[2] && moved.counters().steps == 11);
    std::conditional_t<std::is_same<R, double>::value, nekton_time_error, nekton32_time_error> late;
    CHECK(moved.time_error(late) == NEKTON_OK && late.length_sum > 0 && late.spin_sum >= 0 && late.unknown < 11);
    // Nothing depends on where a lone body is; a rate of its position is what the state says; masses change its acceleration.
    nekton_req space = {};
    CHECK(moved_model.derivatives_req(space) == NEKTON_OK && space.size > 0 && space.align == 8);
    std::vector<std::uint64_t> scratch(space.size / 8 + 1);
    const std::size_t d = moved_model.plan().state_len;
    std::vector<R> a(d * d, R(7)), b(2 * d, R(7));
    R bound = R(-1), qdd[3] = {}, by_position[9], by_velocity[9];
    const nekton_parameter parameters[] = {{NEKTON_PARAMETER_FLUID_DENSITY, 0, 0, 0}, {NEKTON_PARAMETER_MASS, 0, 0, 0}};
    const nekton::Span<R> all_a(a.data(), a.size()), all_b(b.data(), b.size());
    CHECK(moved.linearize(parameters, all_a, all_b, bound, scratch.data(), 8 * scratch.size()) == NEKTON_OK && bound >= 0);
    CHECK(a[0] == R(0) && a[d] == R(0) && a[3 * d] == R(1) && b[3] != R(0) && b[d + 3] != R(0));
    CHECK(moved.accelerations(qdd) == NEKTON_OK);
    CHECK(moved.force_derivatives(qdd, by_position, by_velocity, scratch.data(), 8 * scratch.size()) == NEKTON_OK);
    CHECK(by_position[0] == R(0) && by_velocity[6] != R(0));
    // Memory of the caller.
    nekton_req req = {};
    CHECK(nekton::BasicModel<R>::req(scene, req) == NEKTON_OK);
    std::vector<std::uint64_t> place(req.size / 8 + 1);
    nekton::BasicModel<R> placed(place.data(), 8 * place.size(), scene);
    CHECK(placed && placed.plan().model_bytes == req.size);

    nekton_diag diag = {};
    R two[2];
#ifdef NEKTON_NO_EXCEPTIONS
    CHECK(moved.positions(two) == NEKTON_E_LENGTH);
    CHECK(moved.advance(R(0), &diag) == NEKTON_E_PAST_TIME && diag.status == NEKTON_E_PAST_TIME);
    CHECK(moved.rhs(R(0), two, q, &diag) == NEKTON_E_LENGTH);
    CHECK(moved.linearize(parameters, two, all_b, bound, scratch.data(), 8 * scratch.size(), &diag) == NEKTON_E_LENGTH);
    CHECK(moved.force_derivatives(qdd, q, by_velocity, scratch.data(), 8 * scratch.size()) == NEKTON_E_LENGTH);
    link.nodes = 7;
    nekton::BasicModel<R> refused(scene, &diag);
    CHECK(!refused && diag.status == NEKTON_E_NODE_COUNT && diag.value == 7.0);
#else
    int caught = 0;
    try {
        moved.positions(two);
    } catch (const nekton::Error &error) {
        caught += error.status() == NEKTON_E_LENGTH;
    }
    try {
        moved.advance(R(0), &diag);
    } catch (const nekton::Error &error) {
        caught += error.status() == NEKTON_E_PAST_TIME && diag.status == NEKTON_E_PAST_TIME;
    }
    try {
        moved.rhs(R(0), two, q);
    } catch (const nekton::Error &error) {
        caught += error.status() == NEKTON_E_LENGTH;
    }
    try {
        moved.linearize(parameters, two, all_b, bound, scratch.data(), 8 * scratch.size());
    } catch (const nekton::Error &error) {
        caught += error.status() == NEKTON_E_LENGTH;
    }
    try {
        moved.force_derivatives(qdd, q, by_velocity, scratch.data(), 8 * scratch.size());
    } catch (const nekton::Error &error) {
        caught += error.status() == NEKTON_E_LENGTH;
    }
    try {
        link.nodes = 7;
        nekton::BasicModel<R> refused(scene);
    } catch (const nekton::Error &error) {
        caught += error.status() == NEKTON_E_NODE_COUNT && error.diag().value == 7.0;
    }
    CHECK(caught == 6);
#endif
    return 0;
}

int main() { return run<double>() + run<float>(); }
