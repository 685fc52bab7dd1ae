/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chain of Fermi, Pasta & Ulam (fpu.kernel.h) with four stiff springs: the number is a constant of its
   loops. */
#define GM_SPRINGS 4
#include "tests/problems/fpu.kernel.h"
