/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processor time of a step of the r-adaptive schemes: one soliton, dt = 0.01, medians of several runs; and
   how the cost grows with the number of points. Usage: bench_mesh [runs]

   bench_mesh energy: how well two solitons keep their energy to t = 2000, and what that costs, with constant
   and time-symmetric steps and with densities; rows of like cost compare. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/bench/timing.h"
#include "tests/common/mesh_soliton.h"

/* Microseconds a step, the median over the runs; negative if the run failed. */
static double measure(const char *name, long points, long steps, int runs)
{
    enum { MOST = 99 };
    /* the same Courant number on every mesh: Lobatto IIIA-IIIB is explicit in what it knows of waves */
    const double dt = points <= 31 ? 0.01 : 0.01 * 32 / (double)(points + 1);
    const struct gm_soliton soliton = {
        .solitons = 1, .points = points, .velocity = 0.9, .length = 25, .alpha = 2.5};
    const struct gm_settings settings = {0};
    const struct gm_scheme *scheme = gm_scheme_find(name);
    struct gm_problem problem;
    struct gm_mesh mesh;
    double times[MOST];
    gm_soliton_problem(&soliton, &problem);
    gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
    double *state = malloc(problem.n * sizeof *state);
    if (!state || !scheme ||
        !gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &soliton, state)) {
        free(state);
        return -1;
    }
    bool good = true;
    for (int i = 0; i < runs && i < MOST && good; i++) {
        struct gm_run *run = gm_run_open(&problem, scheme, &settings, 0, dt, state);
        if (!run) {
            good = false;
            break;
        }
        const double before = seconds();
        good = gm_run_advance(run, steps) == GM_OK;
        times[i] = 1e6 * (seconds() - before) / (double)steps;
        if (i == 0 && points == 31) {
            printf("  %-24s %5.2f residuals, %5.3f factorisations a step\n", name,
                   (double)run->evaluations / (double)run->steps,
                   gm_mesh_factorisations(run) / (double)run->steps);
        }
        gm_run_close(run);
    }
    free(state);
    return good ? median(times, (size_t)(runs < MOST ? runs : MOST)) : -1;
}

static void keep_energy(const char *name, int density, double alpha, double dt)
{
    static const char *const densities[] = {"arclength", "curvature", "mix", "limited", "tempered"};
    const struct gm_soliton soliton = {
        .solitons = 2, .density = density, .points = 25, .velocity = 0.9, .length = 25, .alpha = alpha};
    const struct gm_settings settings = {0};
    const struct gm_scheme *scheme = gm_scheme_find(name);
    struct gm_problem problem;
    struct gm_mesh mesh;
    double state[100];
    gm_soliton_problem(&soliton, &problem);
    gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
    struct gm_run *run = NULL;
    if (!scheme || !gm_mesh_start(&mesh, GM_MESH_MOVING, gm_soliton_profile, &soliton, state) ||
        !(run = gm_run_open(&problem, scheme, &settings, 0, dt, state))) {
        printf("  %s could not be started\n", name);
        return;
    }
    const double initial = gm_mesh_energy(&mesh, state);
    double spent = 0, farthest = 0, error = 0;
    while (run->t < 2000 && run->status == GM_OK) {
        const double before = seconds();
        gm_run_advance(run, 1);
        spent += seconds() - before;
        const double *end = gm_run_state(run);
        farthest = fmax(farthest, fabs(gm_mesh_energy(&mesh, end) / initial - 1));
        for (size_t k = 0; run->t <= 50 && k < 25; k++) {
            error = fmax(error, fabs(end[k] - gm_soliton_exact(&soliton, end[25 + k], run->t)));
        }
    }
    printf("  %-22s %-10s %5.2f %6.3f %9.2f %12.1e %9.2f   %s at %.0f\n", name, densities[density], alpha, dt,
           spent, farthest, error, gm_status_name(run->status), run->t);
    gm_run_close(run);
}

static int keep_energies(void)
{
    printf("two solitons, 25 points, to t = 2000\n  %-22s %-10s %5s %6s %9s %12s %9s\n", "scheme", "density",
           "alpha", "dt", "CPU s", "energy err", "err t<50");
    for (double dt = 0.05; dt > 0.034; dt -= 0.005) {
        keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 1.5, dt);
        keep_energy("multiplier-adaptive4", GM_ARCLENGTH, 1.5, dt);
        keep_energy("multiplier-lobatto4", GM_LIMITED, 1.5, dt);
        keep_energy("multiplier-adaptive4", GM_LIMITED, 1.5, dt);
    }
    keep_energy("multiplier-lobatto4", GM_TEMPERED, 1.5, 0.05);
    keep_energy("multiplier-lobatto4", GM_TEMPERED, 1.5, 0.045);
    keep_energy("multiplier-lobatto4", GM_TEMPERED, 1.5, 0.04);
    keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 1, 0.05);
    keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 1.25, 0.05);
    keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 2, 0.05);
    keep_energy("multiplier-lobatto4", GM_LIMITED, 2, 0.05);
    keep_energy("multiplier-lobatto4", GM_LIMITED, 2, 0.045);
    keep_energy("multiplier-lobatto4", GM_LIMITED, 2, 0.04);
    return 0;
}

int main(int count, char **words)
{
    if (count > 1 && strcmp(words[1], "energy") == 0) {
        return keep_energies();
    }
    const int runs = count > 1 && atoi(words[1]) > 0 ? atoi(words[1]) : 5;
    static const char *const names[] = {"uniform-gauss4",         "control-gauss4",
                                        "control-radau5",         "multiplier-lobatto2",
                                        "multiplier-trapezoidal", "multiplier-lobatto4"};
    printf("31 points, 1000 steps of 0.01\n");
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        printf("  %-24s %8.2f us a step\n", names[i], measure(names[i], 31, 1000, runs));
    }
    printf("multiplier-lobatto4, 40 steps of 0.32 / (points + 1)\n  %8s %12s %14s\n", "points", "us a step",
           "ns a point");
    for (long points = 63; points <= 4095; points = 2 * points + 1) {
        const double time = measure("multiplier-lobatto4", points, 40, runs);
        printf("  %8ld %12.1f %14.1f\n", points, time, 1e3 * time / (double)points);
    }
    return 0;
}
