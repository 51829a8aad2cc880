/** Part of nekton.hpp: simulations. */
#ifndef NEKTON_SIM_HPP
#define NEKTON_SIM_HPP

#include "api.hpp"
#include "error.hpp"
#include "model.hpp"
#include "span.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace nekton {

/** A simulation of a model. One thread at a time, even to read it (else NEKTON_E_BUSY). Moves; copies of the state by copy_from. */
template <class R> class BasicSim {
    using Api = detail::Api<R>;

public:
    /** No simulation. */
    BasicSim() noexcept = default;
    /** Starts a simulation in memory from the heap. */
    BasicSim(const BasicModel<R> &model, const typename Api::Method &method, nekton_diag *diag = nullptr) : owned_(true)
    {
        detail::call(diag, [&](nekton_diag *d) { return Api::sim_create(model.get(), &method, &sim_, d); });
    }
    /** Starts a simulation in memory of the caller (see req), which must stay as long as the simulation. */
    BasicSim(void *memory, std::size_t size, const BasicModel<R> &model, const typename Api::Method &method,
             nekton_diag *diag = nullptr)
    {
        detail::call(diag, [&](nekton_diag *d) { return Api::sim_init(memory, size, model.get(), &method, &sim_, d); });
    }
    BasicSim(BasicSim &&other) noexcept
        : sim_(std::exchange(other.sim_, nullptr)), owned_(std::exchange(other.owned_, false))
    {
    }
    BasicSim &operator=(BasicSim &&other) noexcept
    {
        std::swap(sim_, other.sim_);
        std::swap(owned_, other.owned_);
        return *this;
    }
    BasicSim(const BasicSim &) = delete;
    BasicSim &operator=(const BasicSim &) = delete;
    ~BasicSim()
    {
        if (owned_) {
            Api::sim_free(sim_);
        }
    }
    /** Memory that a simulation needs. */
    static nekton_status req(const BasicModel<R> &model, const typename Api::Method &method, nekton_req &out,
                             nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_req(model.get(), &method, &out, d); });
    }

    /** There is a simulation. */
    explicit operator bool() const noexcept { return sim_ != nullptr; }
    /** The handle, for functions of C. */
    typename Api::Sim *get() noexcept { return sim_; }
    const typename Api::Sim *get() const noexcept { return sim_; }

    /** The handle of its model; null if there is no simulation. */
    const typename Api::Model *model() const
    {
        const typename Api::Model *out = nullptr;
        detail::done(Api::sim_model(sim_, &out));
        return out;
    }
    /** Goes on exactly as another simulation of the same model. */
    nekton_status copy_from(const BasicSim &other, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_copy(sim_, other.sim_, d); });
    }

    /** Bytes that save writes. */
    std::size_t save_size() const
    {
        std::size_t n = 0;
        detail::done(Api::sim_save_req(sim_, &n));
        return n;
    }
    /** Writes all that the simulation remembers to memory of len bytes; written: how many there are. */
    nekton_status save(void *out, std::size_t len, std::size_t &written, nekton_diag *diag = nullptr) const
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_save(sim_, out, len, &written, d); });
    }
    /** Becomes what was saved, by itself or by another simulation of an equal model, in any process. */
    nekton_status load(const void *from, std::size_t len, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_load(sim_, from, len, d); });
    }

    /** Time of the state shown; NaN if there is no simulation. */
    R time() const
    {
        R t = std::numeric_limits<R>::quiet_NaN();
        detail::done(Api::sim_time(sim_, &t));
        return t;
    }
    /** x, y, theta of every link's centre of mass: 3 numbers per link. */
    nekton_status positions(Span<R> q) const { return detail::done(Api::sim_positions(sim_, q.data(), q.size())); }
    /** Their rates. */
    nekton_status velocities(Span<R> qd) const { return detail::done(Api::sim_velocities(sim_, qd.data(), qd.size())); }
    /** Time and integrated state: plan().state_len numbers. */
    nekton_status state(R &t, Span<R> y) const { return detail::done(Api::sim_get_state(sim_, &t, y.data(), y.size())); }
    /** Sets time and state; the integrator starts anew. */
    nekton_status set_state(R t, Span<const R> y, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_set_state(sim_, t, y.data(), y.size(), d); });
    }
    /** Forgets the integrator's past. */
    nekton_status restart() { return detail::done(Api::sim_restart(sim_)); }
    /** One step of the method. */
    nekton_status step(nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_step(sim_, d); });
    }
    /** Advances to exactly t_end. */
    nekton_status advance(R t_end, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_advance(sim_, t_end, d); });
    }
    /** Shows the state at t_out; the integrator may run ahead, but not beyond t_stop. */
    nekton_status advance_dense(R t_out, R t_stop, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_advance_dense(sim_, t_out, t_stop, d); });
    }
    /** How many steps one advance may make (at first 1000000). */
    nekton_status set_step_limit(std::uint64_t steps)
    {
        return detail::call(nullptr, [&](nekton_diag *) { return Api::sim_set_step_limit(sim_, steps); });
    }
    /** Sets a channel: (t, u, du/dt, d2u/dt2) at both ends of the coming interval. */
    nekton_status set_channel(std::size_t channel, const std::array<R, 4> &from, const std::array<R, 4> &to,
                              nekton_diag *diag = nullptr)
    {
        return detail::call(diag,
                            [&](nekton_diag *d) { return Api::sim_set_channel(sim_, channel, from.data(), to.data(), d); });
    }
    /** dy/dt for an integrator of your own; both of plan().state_len numbers. */
    nekton_status rhs(R t, Span<const R> y, Span<R> ydot, nekton_diag *diag = nullptr)
    {
        return two(y.size(), ydot.size(), diag,
                   [&](nekton_diag *d) { return Api::sim_rhs(sim_, t, y.data(), ydot.data(), ydot.size(), d); });
    }
    /** Value and rate of every joint. */
    nekton_status joint_values(Span<R> u, Span<R> du)
    {
        return two(u.size(), du.size(), nullptr,
                   [&](nekton_diag *) { return Api::sim_joint_values(sim_, u.data(), du.data(), du.size()); });
    }
    /** Torque that drives every joint, and its power. */
    nekton_status joint_torques(Span<R> torque, Span<R> power, nekton_diag *diag = nullptr)
    {
        return two(torque.size(), power.size(), diag,
                   [&](nekton_diag *d) { return Api::sim_joint_torques(sim_, torque.data(), power.data(), power.size(), d); });
    }

    /** Each of these fills 3 numbers per link. */
    nekton_status accelerations(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_accelerations, out, diag); }
    nekton_status christoffel(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_christoffel, out, diag); }
    nekton_status buoyancy(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_buoyancy, out, diag); }
    nekton_status repulsion(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_repulsion, out, diag); }
    nekton_status circulation_gradient(Span<R> out, nekton_diag *diag = nullptr)
    {
        return fill(Api::sim_circulation_gradient, out, diag);
    }
    /** Each of these fills a square matrix of 3 rows per link, column by column. */
    nekton_status mass_matrix(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_mass_matrix, out, diag); }
    nekton_status added_mass(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_added_mass, out, diag); }
    nekton_status gyroscopic(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_gyroscopic, out, diag); }
    /** The full tensor, (3 links)^3 numbers. */
    nekton_status christoffel_tensor(Span<R> out, nekton_diag *diag = nullptr)
    {
        return fill(Api::sim_christoffel_tensor, out, diag);
    }

    /** Derivatives of dy/dt by the state, a (d x d for d = plan().state_len), and by parameters, b (d x their number), column by
     *  column, and a bound of their relative error in space. Memory: see BasicModel::derivatives_req. */
    nekton_status linearize(Span<const nekton_parameter> parameters, Span<R> a, Span<R> b, R &bound, void *memory,
                            std::size_t size, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) {
            return Api::sim_linearize(sim_, parameters.data(), parameters.size(), a.data(), a.size(), b.data(), b.size(),
                                      &bound, memory, size, d);
        });
    }
    /** Derivatives of the links' force by positions and by velocities for given accelerations (3 per link), square matrices. */
    nekton_status force_derivatives(Span<const R> qdd, Span<R> position, Span<R> velocity, void *memory, std::size_t size,
                                    nekton_diag *diag = nullptr)
    {
        const std::size_t n = qdd.size();
        // C has no lengths of the matrices.
        const std::size_t given = position.size() == velocity.size() ? position.size() : 0;
        return two(given, n * n, diag, [&](nekton_diag *d) {
            return Api::sim_force_derivatives(sim_, qdd.data(), n, position.data(), velocity.data(), memory, size, d);
        });
    }

    /** Energies at the state shown. */
    nekton_status energy(typename Api::Energy &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_energy(sim_, &out, d); });
    }
    /** Total energy minus work, now minus at first; the largest kinetic energy met; what is noticed. */
    nekton_status energy_drift(std::array<R, 3> &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_energy_drift(sim_, out.data(), d); });
    }
    /** Linear impulse and angular impulse about the origin. */
    nekton_status impulse(std::array<R, 3> &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_impulse(sim_, out.data(), d); });
    }
    /** Error indicators of the steps of the last call that stepped. */
    nekton_status indicators(typename Api::Resolution &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_indicators(sim_, &out, d); });
    }
    /** Error indicators of the space discretization at the state shown, from all of the added mass. */
    nekton_status resolution(typename Api::Resolution &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_resolution(sim_, &out, d); });
    }
    /** Estimated local errors of time integration since the start. */
    nekton_status time_error(typename Api::TimeError &out) const
    {
        return detail::done(Api::sim_time_error(sim_, &out));
    }
    /** The smallest gap between boundaries of which one moves. */
    nekton_status gap(typename Api::Gap &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_gap(sim_, &out, d); });
    }
    /** What the simulation did since its start; zeros if there is no simulation. */
    nekton_counters counters() const
    {
        nekton_counters out = {};
        detail::done(Api::sim_counters(sim_, &out));
        return out;
    }

private:
    template <class F> nekton_status fill(F function, Span<R> out, nekton_diag *diag)
    {
        return detail::call(diag, [&](nekton_diag *d) { return function(sim_, out.data(), out.size(), d); });
    }
    /** For functions of C with one length for two buffers. */
    template <class F> nekton_status two(std::size_t first, std::size_t second, nekton_diag *diag, F function)
    {
        return detail::call(diag, [&](nekton_diag *d) {
            if (first != second) {
                *d = detail::plain(NEKTON_E_LENGTH);
                return nekton_status{NEKTON_E_LENGTH};
            }
            return function(d);
        });
    }

    typename Api::Sim *sim_ = nullptr;
    bool owned_ = false;
};

} // namespace nekton

#endif /* NEKTON_SIM_HPP */
