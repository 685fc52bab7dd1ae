/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of tours against any bytes: it reads them, or gives a sentence that names a line. */
#include "app/tours/tour.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char message[GM_MESSAGE] = "";
    struct gm_tour tour;
    if (gm_tour_parse(&tour, "x", (const char *)data, size, message)) {
        require(tour.count > 0 && tour.title && tour.steps[0].show);
        for (size_t i = 0; i < tour.count; i++) {
            require(tour.steps[i].say && gm_tour_begin(&tour, i) <= tour.steps[i].until);
        }
        gm_tour_close(&tour);
    } else {
        require(message[0] != '\0' && strlen(message) < GM_MESSAGE && tour.count == 0);
    }
    return 0;
}
