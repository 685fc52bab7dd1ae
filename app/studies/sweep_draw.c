/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a sweep. */
#include "app/studies/sweep.h"
