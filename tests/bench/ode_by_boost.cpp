// SPDX-License-Identifier: GPL-3.0-or-later
// The same by Boost's odeint.
#include <array>
#include <cmath>

#include <boost/numeric/odeint.hpp>

#include "tests/bench/ode_by_hand.h"

namespace odeint = boost::numeric::odeint;

using pair = std::array<double, 2>;

extern "C" void gm_boost_kepler_verlet(double *y, double h, long steps) {
    pair q = {y[0], y[1]}, p = {y[2], y[3]};
    odeint::velocity_verlet<pair> stepper;
    const auto force = [](const pair &at, const pair &, pair &a, double) {
        const double square = at[0] * at[0] + at[1] * at[1], pull = 1 / (square * std::sqrt(square));
        a[0] = -pull * at[0];
        a[1] = -pull * at[1];
    };
    auto both = std::make_pair(std::ref(q), std::ref(p));
    for (long i = 0; i < steps; i++) {
        stepper.do_step(force, both, 0.0, h);
    }
    y[0] = q[0], y[1] = q[1], y[2] = p[0], y[3] = p[1];
}

template <size_t n, class Field> static void rk4(Field field, double *y, double h, long steps) {
    std::array<double, n> state;
    std::copy(y, y + n, state.begin());
    odeint::runge_kutta4<std::array<double, n>> stepper;
    for (long i = 0; i < steps; i++) {
        stepper.do_step(field, state, 0.0, h);
    }
    std::copy(state.begin(), state.end(), y);
}

extern "C" void gm_boost_kepler_rk4(double *y, double h, long steps) {
    rk4<4>(
        [](const std::array<double, 4> &at, std::array<double, 4> &f, double) {
            const double square = at[0] * at[0] + at[1] * at[1], pull = 1 / (square * std::sqrt(square));
            f[0] = at[2];
            f[1] = at[3];
            f[2] = -pull * at[0];
            f[3] = -pull * at[1];
        },
        y, h, steps);
}

extern "C" void gm_boost_vortices_rk4(double *y, double h, long steps) {
    rk4<8>(
        [](const std::array<double, 8> &at, std::array<double, 8> &f, double) {
            f.fill(0);
            for (int i = 0; i < 4; i++) {
                for (int j = i + 1; j < 4; j++) {
                    const double dx = at[i] - at[j], dy = at[4 + i] - at[4 + j];
                    const double turn = GM_HAND_STRENGTH / (2 * M_PI) / (dx * dx + dy * dy);
                    f[i] -= turn * dy;
                    f[j] += turn * dy;
                    f[4 + i] += turn * dx;
                    f[4 + j] -= turn * dx;
                }
            }
        },
        y, h, steps);
}

extern "C" void gm_boost_kepler_rkf78(double *y, double until, double tolerance) {
    using quadruple = std::array<double, 4>;
    quadruple state = {y[0], y[1], y[2], y[3]};
    const auto field = [](const quadruple &at, quadruple &f, double) {
        const double square = at[0] * at[0] + at[1] * at[1], pull = 1 / (square * std::sqrt(square));
        f[0] = at[2];
        f[1] = at[3];
        f[2] = -pull * at[0];
        f[3] = -pull * at[1];
    };
    odeint::integrate_adaptive(
        odeint::make_controlled<odeint::runge_kutta_fehlberg78<quadruple>>(tolerance, tolerance), field, state,
        0.0, until, 1e-2);
    std::copy(state.begin(), state.end(), y);
}
