/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_TYPED_H
#define GM_TESTS_COMMON_TYPED_H

#include "core/model/equations.h"
#include "core/ode/user/problem.h"
#include "core/run.h"

/* A system that is typed, with its problem and its start. */
struct typed {
    struct gm_user_system system;
    struct gm_user_model model;
    struct gm_problem problem;
    double *start;
};

/* Fails with the fault where the text is no system. */
void type(struct typed *typed, const char *text);
void untype(struct typed *typed);

/* The state after so many steps of a scheme that fits, all of them well. */
void typed_advance(const struct typed *typed, const struct gm_settings *settings, const char *scheme,
                   double dt, long steps, double *end);

/* The largest difference of n numbers; infinite where one of `a` is none. */
double typed_apart(const double *a, const double *b, size_t n);

#endif
