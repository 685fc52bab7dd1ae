/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What takes very long is asked about first. */
#include "app/commands/confirmed.h"

#include <stdio.h>

#include "app/output/say.h"
#include "app/words/drive.h"
#include "core/basics.h"

const double gm_many_steps = 1e11;

void gm_put_duration(double seconds, char *text, size_t size)
{
    static const struct {
        double seconds;
        const char *name;
    } units[] = {
        {365.25 * 86400, "years"}, {86400, "days"}, {3600, "hours"}, {60, "minutes"}, {1, "seconds"}};
    size_t unit = 0;
    while (unit + 1 < GM_COUNT(units) && seconds < 2 * units[unit].seconds) {
        unit++;
    }
    const double count = seconds / units[unit].seconds;
    snprintf(text, size, count < 1e5 ? "%.*f %s" : "%.*g %s", count < 9.5 ? 1 : 0, count, units[unit].name);
}

bool gm_command_confirmed(const struct gm_options *options, const struct gm_request *request)
{
    double steps = 0, seconds = 0;
    for (size_t i = 0; i < request->count; i++) {
        steps += gm_request_steps(request, i);
    }
    if (options->yes || steps <= gm_many_steps) {
        return true;
    }
    for (size_t i = 0; i < request->count; i++) {
        seconds += gm_drive_seconds(request, i);
    }
    char duration[64];
    gm_put_duration(seconds, duration, sizeof duration);
    gm_complain("these are %.3g steps, which take about %s; --yes makes them", steps, duration);
    return false;
}
