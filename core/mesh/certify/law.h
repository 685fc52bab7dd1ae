/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_CERTIFY_LAW_H
#define GM_CORE_MESH_CERTIFY_LAW_H

#include "core/mesh/certify/subject.h"

/* The defect of the local law that core/mesh/certify/law.c states; NaN if it does not apply. */
double gm_mesh_law_defect(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt);

#endif
