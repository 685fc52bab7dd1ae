/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of triangles by a word and its numbers: rectangle flat-torus disc annulus sphere torus. */
#ifndef GM_CORE_FORM_GENERATORS_H
#define GM_CORE_FORM_GENERATORS_H

#include "core/expression/reader.h"
#include "core/form/complex.h"

/* rectangle W H N [M], flat-torus W H N [M], disc R n, annulus R1 R2 N [m], sphere R level, torus R r N [M]. A
   generator checks its numbers: false with a fault at that place of a text. */
bool gm_generator_check(const char *word, const double *numbers, size_t count, size_t place,
                        struct gm_fault *fault);

/* The mesh of a word and numbers that were checked. NULL with a fault of the star, or when out of memory. */
struct gm_complex *gm_generator_open(const char *word, const double *numbers, size_t count, enum gm_star star,
                                     struct gm_triangulation_fault *fault);

/* The names of the parts of a mesh's boundary; a NULL ends them. */
const char *const *gm_generator_parts(const char *word);
/* True if an edge of the boundary with this middle is on a part, or on any part if that is "all". */
bool gm_generator_on(const char *word, const double *numbers, const char *part, const double middle[3]);

#endif
