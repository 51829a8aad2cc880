/** Part of nekton.hpp: chooses between the functions and types of the two precisions. */
#ifndef NEKTON_API_HPP
#define NEKTON_API_HPP

#include "../nekton32.h"

namespace nekton {

namespace detail {

template <class R> struct Api;

#define NEKTON_P_API(R, P)                                                                                                     \
    template <> struct Api<R> {                                                                                                \
        using Shape = P##_shape;                                                                                               \
        using Signal = P##_signal;                                                                                             \
        using Harmonic = P##_harmonic;                                                                                         \
        using Wall = P##_wall_def;                                                                                             \
        using Link = P##_link_def;                                                                                             \
        using Body = P##_body_def;                                                                                             \
        using Scene = P##_scene_def;                                                                                           \
        using Method = P##_method;                                                                                             \
        using Model = P##_model;                                                                                               \
        using Sim = P##_sim;                                                                                                   \
        using LinkInfo = P##_link_info;                                                                                        \
        using Energy = P##_energy;                                                                                             \
        using Resolution = P##_resolution;                                                                                     \
        using TimeError = P##_time_error;                                                                                      \
        using Gap = P##_gap;                                                                                                   \
        static constexpr auto scene_init = &P##_scene_def_init;                                                                \
        static constexpr auto wall_init = &P##_wall_def_init;                                                                  \
        static constexpr auto body_init = &P##_body_def_init;                                                                  \
        static constexpr auto link_init = &P##_link_def_init;                                                                  \
        static constexpr auto method_init = &P##_method_init;                                                                  \
        static constexpr auto model_req = &P##_model_req;                                                                      \
        static constexpr auto model_init = &P##_model_init;                                                                    \
        static constexpr auto model_create = &P##_model_create;                                                                \
        static constexpr auto model_free = &P##_model_free;                                                                    \
        static constexpr auto model_plan = &P##_model_plan;                                                                    \
        static constexpr auto model_link = &P##_model_link;                                                                    \
        static constexpr auto model_joint = &P##_model_joint;                                                                  \
        static constexpr auto model_notice = &P##_model_notice;                                                                \
        static constexpr auto model_nodes = &P##_model_nodes;                                                                  \
        static constexpr auto model_outline_error = &P##_model_outline_error;                                                  \
        static constexpr auto model_outline_point = &P##_model_outline_point;                                                  \
        static constexpr auto sim_req = &P##_sim_req;                                                                          \
        static constexpr auto sim_init = &P##_sim_init;                                                                        \
        static constexpr auto sim_create = &P##_sim_create;                                                                    \
        static constexpr auto sim_free = &P##_sim_free;                                                                        \
        static constexpr auto sim_copy = &P##_sim_copy;                                                                        \
        static constexpr auto sim_save_req = &P##_sim_save_req;                                                                \
        static constexpr auto sim_save = &P##_sim_save;                                                                        \
        static constexpr auto sim_load = &P##_sim_load;                                                                        \
        static constexpr auto sim_model = &P##_sim_model;                                                                      \
        static constexpr auto sim_time = &P##_sim_time;                                                                        \
        static constexpr auto sim_positions = &P##_sim_positions;                                                              \
        static constexpr auto sim_velocities = &P##_sim_velocities;                                                            \
        static constexpr auto sim_get_state = &P##_sim_get_state;                                                              \
        static constexpr auto sim_set_state = &P##_sim_set_state;                                                              \
        static constexpr auto sim_restart = &P##_sim_restart;                                                                  \
        static constexpr auto sim_step = &P##_sim_step;                                                                        \
        static constexpr auto sim_advance = &P##_sim_advance;                                                                  \
        static constexpr auto sim_advance_dense = &P##_sim_advance_dense;                                                      \
        static constexpr auto sim_set_step_limit = &P##_sim_set_step_limit;                                                    \
        static constexpr auto sim_set_channel = &P##_sim_set_channel;                                                          \
        static constexpr auto sim_rhs = &P##_sim_rhs;                                                                          \
        static constexpr auto sim_joint_values = &P##_sim_joint_values;                                                        \
        static constexpr auto sim_joint_torques = &P##_sim_joint_torques;                                                      \
        static constexpr auto sim_accelerations = &P##_sim_accelerations;                                                      \
        static constexpr auto sim_mass_matrix = &P##_sim_mass_matrix;                                                          \
        static constexpr auto sim_added_mass = &P##_sim_added_mass;                                                            \
        static constexpr auto sim_christoffel = &P##_sim_christoffel;                                                          \
        static constexpr auto sim_christoffel_tensor = &P##_sim_christoffel_tensor;                                            \
        static constexpr auto sim_buoyancy = &P##_sim_buoyancy;                                                                \
        static constexpr auto sim_repulsion = &P##_sim_repulsion;                                                              \
        static constexpr auto sim_circulation_gradient = &P##_sim_circulation_gradient;                                        \
        static constexpr auto sim_gyroscopic = &P##_sim_gyroscopic;                                                            \
        static constexpr auto sim_derivatives_req = &P##_sim_derivatives_req;                                                  \
        static constexpr auto sim_linearize = &P##_sim_linearize;                                                              \
        static constexpr auto sim_force_derivatives = &P##_sim_force_derivatives;                                              \
        static constexpr auto sim_energy = &P##_sim_energy;                                                                    \
        static constexpr auto sim_energy_drift = &P##_sim_energy_drift;                                                        \
        static constexpr auto sim_impulse = &P##_sim_impulse;                                                                  \
        static constexpr auto sim_indicators = &P##_sim_indicators;                                                            \
        static constexpr auto sim_resolution = &P##_sim_resolution;                                                            \
        static constexpr auto sim_time_error = &P##_sim_time_error;                                                            \
        static constexpr auto sim_gap = &P##_sim_gap;                                                                          \
        static constexpr auto sim_counters = &P##_sim_counters;                                                                \
    }
NEKTON_P_API(double, nekton);
NEKTON_P_API(float, nekton32);
#undef NEKTON_P_API

} // namespace detail

} // namespace nekton

#endif /* NEKTON_API_HPP */
