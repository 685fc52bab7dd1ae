/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pendulum that is typed as a formula, by two schemes: cc example.c $(pkg-config --cflags --libs
   geomint) */
#include <geomint.h>
#include <stdio.h>

int main(void)
{
    const char *const words[] = {"system", "H=p^2/2 - cos(q)", "q=2", "p=0", "dt=0.1", "scheme=rk4,verlet"};
    geomint *run = geomint_open(sizeof words / sizeof *words, words);
    if (geomint_status(run) != GEOMINT_OK) {
        fprintf(stderr, "%s\n", geomint_message(run));
        geomint_close(run);
        return 1;
    }
    for (size_t lane = 0; lane < geomint_lanes(run); lane++) {
        const double *y = geomint_state(run, lane, NULL, NULL); /* q and p, now and after every step */
        double error = 0;
        for (int t = 0; t <= 1000; t += 250) {
            geomint_until(run, lane, t);
            geomint_observable(run, lane, "energy_error", &error);
            printf("t = %4g  q = %8.5f  p = %8.5f  energy error %.1e\n", geomint_time(run, lane), y[0], y[1],
                   error);
        }
    }
    if (geomint_save(run, "pendulum.svg", 1280, 720, 1, NULL) != GEOMINT_OK) {
        fprintf(stderr, "%s\n", geomint_message(run));
    }
    geomint_close(run);
    return 0;
}
