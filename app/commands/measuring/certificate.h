/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_MEASURING_CERTIFICATE_H
#define GM_APP_COMMANDS_MEASURING_CERTIFICATE_H

#include "core/certify.h"
#include "render/picture/picture.h"

/* A certificate as text. */
void gm_certificate_print(const struct gm_certificate *certificate);

/* The diagram of the order: errors against dt, beside lines of the order that is claimed. Of a name that
   several rows have, each has its line. */
struct gm_orders {
    const struct gm_certificate *certificates;
    size_t count;
};
/* Whether there is anything to draw. */
bool gm_orders_are_known(const struct gm_orders *orders);
/* For gm_command_chart: `data` is struct gm_orders. */
void gm_orders_draw(const void *data, struct gm_picture *picture);
bool gm_orders_write(const void *data, const char *path);

#endif
