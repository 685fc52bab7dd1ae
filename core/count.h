/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_COUNT_H
#define GM_CORE_COUNT_H

/* How many elements an array has. */
#define GM_COUNT(array) (sizeof(array) / sizeof(array)[0])

#endif
