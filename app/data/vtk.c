/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States for VTK: FILE.pvd is a list of times and files; these lie in the folder FILE, one .vtu file a row
   for the mesh, the line or the bodies, and one for the tracers. "VTK XML Formats", vtk.org; raw appended
   data, lowest byte first. The file of a lane in the making holds its lines of the list.

   FILE.xdmf is a list of times, too, and of places in one file a lane, laneN.bin in the folder FILE, which has the
   arrays that do not change once, and then the others, row by row. "XDMF Model and Format", xdmf.org. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/data/format.h"
#include "app/output/folder.h"
#include "core/basics.h"
#include "render/message.h"

/* The connection of a group's points. */
enum shape { POINTS, LINE, TRIANGLES };

/* All quantities that belong to one set of points. */
struct group {
    const struct gm_saved *lane;
    const struct gm_run *run;
    enum gm_support support;
    enum shape shape;
    size_t points, cells;
    const struct gm_quantity *axes[3]; /* NULL: 0 */
    const struct gm_quantity *height;  /* the y of a line */
    const struct gm_quantity *corners; /* the corners of triangles */
    bool apart; /* each triangle has corners of its own, as on a torus, whose seam would be drawn across */
};

enum section { FIELD, POINT, CELL, PLACES, TOPOLOGY, SECTIONS };
enum { SOLID = 3 /* VTK's vectors have three components */, LONGEST = 32 };
enum { VTK_POLY_VERTEX = 2, VTK_POLY_LINE = 4, VTK_TRIANGLE = 5 };

/* An array of a file: the entries of its head, and its content. */
struct array {
    enum section section;
    const char *name, *type;
    size_t components, tuples, item; /* item: bytes of a number */
    bool fixed;                      /* the same in all rows */
    enum { TIME, QUANTITY, POSITIONS, CONNECTIVITY, OFFSETS, TYPES } content;
    const struct gm_quantity *quantity;
};

/* The first quantity on a support that is the axis 1, 2, 3, or for 0 not a coordinate; or NULL. */
static const struct gm_quantity *axis_of(const struct gm_saved *lane, enum gm_support support, int axis)
{
    for (size_t i = 0; i < lane->count; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        if (quantity->support == support && quantity->axis == axis) {
            return quantity;
        }
    }
    return NULL;
}

/* Returns false if the lane has nothing on this support. */
static bool group_of(const struct gm_saved *lane, const struct gm_run *run, enum gm_support support,
                     struct group *group)
{
    *group = (struct group){.lane = lane, .run = run, .support = support, .cells = 1};
    for (int axis = 0; axis < 3; axis++) {
        group->axes[axis] = axis_of(lane, support, axis + 1);
    }
    if (!group->axes[0]) {
        return false;
    }
    group->points = group->axes[0]->count * lane->members;
    if (support == GM_ON_NODES) {
        group->corners = axis_of(lane, GM_ON_CELLS, 0);
        group->shape = group->corners ? TRIANGLES : LINE;
        group->cells = group->corners ? group->corners->count : 1;
        group->height = group->corners ? NULL : axis_of(lane, support, 0);
        group->apart = group->corners && (group->axes[0]->period[0] > 0 || group->axes[0]->period[1] > 0);
        group->points = group->apart ? group->corners->width * group->cells : group->points;
    }
    return true;
}

static const double *values_of(const struct group *group, const struct gm_quantity *quantity)
{
    return gm_quantity_values(group->run, quantity, group->lane->scratch);
}

/* Corner by corner of triangles that have their own: each value is that of its vertex, a place the nearest to
   the triangle's first corner. */
static void write_apart(const struct group *group, const struct gm_quantity *quantity, size_t components,
                        struct gm_column *out)
{
    const size_t width = quantity->width, vertices = group->axes[0]->count;
    double *values = malloc(width * vertices * sizeof *values);
    errno = ENOMEM;
    gm_bytes_note(out->file, values);
    if (!values) {
        return;
    }
    memcpy(values, values_of(group, quantity), width * vertices * sizeof *values);
    const double *corners = values_of(group, group->corners);
    for (size_t k = 0; k < group->points; k++) {
        const size_t first = k - k % group->corners->width;
        double vector[SOLID] = {0};
        for (size_t c = 0; c < width; c++) {
            const double period = quantity->axis > 0 ? quantity->period[c] : 0;
            const double near = values[width * (size_t)corners[first] + c];
            vector[c] = values[width * (size_t)corners[k] + c];
            vector[c] -= period > 0 ? period * round((vector[c] - near) / period) : 0;
        }
        gm_column_put(out, vector, components * sizeof *vector);
    }
    free(values);
}

/* Writes coordinates point by point. Quantities may have to be derived one by one, so x, y and z are
   collected first. */
static void write_places(const struct group *group, struct gm_column *out)
{
    if (group->apart) {
        write_apart(group, group->axes[0], SOLID, out);
        return;
    }
    double *places = calloc(group->points, SOLID * sizeof *places);
    errno = ENOMEM;
    gm_bytes_note(out->file, places);
    if (!places) {
        return;
    }
    for (size_t axis = 0; axis < SOLID; axis++) {
        const struct gm_quantity *quantity = group->axes[axis];
        quantity = axis == 1 && group->height ? group->height : quantity;
        if (!quantity) {
            continue;
        }
        const double *values = values_of(group, quantity);
        for (size_t k = 0; k < group->points; k++) {
            for (size_t c = 0; c < quantity->width; c++) {
                places[SOLID * k + axis + c] = values[quantity->width * k + c];
            }
        }
    }
    gm_column_put(out, places, SOLID * group->points * sizeof *places);
    free(places);
}

static void write_whole(struct gm_column *out, int64_t number)
{
    gm_column_put(out, &number, sizeof number);
}

static void write_values(const struct group *group, const struct array *array, struct gm_column *out)
{
    const struct gm_quantity *quantity = array->quantity;
    if (group->apart && array->section == POINT) {
        write_apart(group, quantity, array->components, out);
        return;
    }
    const double *values = values_of(group, quantity);
    if (array->components == quantity->width) {
        gm_column_put(out, values, array->components * array->tuples * sizeof *values);
        return;
    }
    for (size_t k = 0; k < array->tuples; k++) {
        double vector[SOLID] = {0};
        memcpy(vector, values + quantity->width * k, quantity->width * sizeof *values);
        gm_column_put(out, vector, SOLID * sizeof *vector);
    }
}

static void write_array(const struct group *group, const struct array *array, struct gm_column *out)
{
    static const unsigned char types[] = {
        [POINTS] = VTK_POLY_VERTEX, [LINE] = VTK_POLY_LINE, [TRIANGLES] = VTK_TRIANGLE};
    const struct gm_quantity *corners = group->corners;
    const double *indices = NULL;
    switch (array->content) {
    case TIME:
        gm_column_put(out, &group->run->t, sizeof group->run->t);
        break;
    case QUANTITY:
        write_values(group, array, out);
        break;
    case POSITIONS:
        write_places(group, out);
        break;
    case CONNECTIVITY:
        indices = corners && !group->apart ? values_of(group, corners) : NULL;
        for (size_t k = 0; k < array->tuples; k++) {
            write_whole(out, indices ? (int64_t)indices[k] : (int64_t)k);
        }
        break;
    case OFFSETS:
        for (size_t k = 1; k <= group->cells; k++) {
            write_whole(out, (int64_t)(corners ? corners->width * k : group->points));
        }
        break;
    case TYPES:
        for (size_t k = 0; k < group->cells; k++) {
            gm_column_put(out, &types[group->shape], 1);
        }
        break;
    }
}

/* The section of a quantity; SECTIONS: this file leaves it out. */
static enum section section_of(const struct group *group, const struct gm_quantity *quantity)
{
    const bool line = group->shape == LINE && quantity->fixed; /* the line's grid is the points' x */
    if (quantity == group->corners || line || quantity == group->axes[0] || quantity == group->axes[1] ||
        quantity == group->axes[2]) {
        return SECTIONS;
    }
    if (quantity->support == group->support) {
        return POINT;
    }
    if (quantity->support == GM_ON_CELLS && group->shape == TRIANGLES) {
        return CELL;
    }
    return quantity->support == GM_ON_RUN && group->lane->members == 1 ? FIELD : SECTIONS;
}

static size_t list_arrays(const struct group *group, struct array arrays[LONGEST])
{
    size_t count = 0;
    arrays[count++] = (struct array){FIELD, "TimeValue", "Float64", 1, 1, 8, false, TIME, NULL};
    for (size_t i = 0; i < group->lane->count; i++) {
        const struct gm_quantity *quantity = &group->lane->quantities[i];
        const enum section section = section_of(group, quantity);
        const size_t components = quantity->width > 1 ? SOLID : 1,
                     all = quantity->count * group->lane->members,
                     tuples = section == POINT && group->apart ? group->points : all;
        if (section != SECTIONS) {
            arrays[count++] = (struct array){section, quantity->name,  "Float64", components, tuples,
                                             8,       quantity->fixed, QUANTITY,  quantity};
        }
    }
    const size_t points = group->points, cells = group->cells,
                 corners = group->corners ? group->corners->width * cells : points;
    const struct array others[] = {
        {PLACES, "Points", "Float64", SOLID, points, 8, !group->height && group->axes[0]->fixed, POSITIONS,
         NULL},
        {TOPOLOGY, "connectivity", "Int64", 1, corners, 8, true, CONNECTIVITY, NULL},
        {TOPOLOGY, "offsets", "Int64", 1, cells, 8, true, OFFSETS, NULL},
        {TOPOLOGY, "types", "UInt8", 1, cells, 1, true, TYPES, NULL},
    };
    memcpy(&arrays[count], others, sizeof others);
    return count + GM_COUNT(others);
}

static uint64_t bytes_of(const struct array *array)
{
    return array->components * array->tuples * array->item;
}

static void write_head(const struct group *group, const struct array *arrays, size_t count,
                       struct gm_column *out)
{
    static const char *const names[] = {"FieldData", "PointData", "CellData", "Points", "Cells"};
    gm_column_print(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n");
    for (int section = FIELD; section < SECTIONS; section++) {
        uint64_t offset = 0;
        gm_column_print(out, "<%s>\n", names[section]);
        for (size_t i = 0; i < count; i++) {
            if ((int)arrays[i].section == section) {
                gm_column_print(
                    out,
                    "<DataArray type=\"%s\" Name=\"%s\" %s=\"%zu\" format=\"appended\" offset=\"%" PRIu64
                    "\"/>\n",
                    arrays[i].type, arrays[i].name,
                    section == FIELD ? "NumberOfTuples" : "NumberOfComponents",
                    section == FIELD ? arrays[i].tuples : arrays[i].components, offset);
            }
            offset += sizeof offset + bytes_of(&arrays[i]);
        }
        gm_column_print(out, "</%s>\n", names[section]);
        if (section == FIELD) {
            gm_column_print(out, "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n", group->points,
                            group->cells);
        }
    }
    gm_column_print(out, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
}

/* Writes from a place of a file on; column 0 is the list. */
static struct gm_column *begin_file(struct gm_saved *lane, struct gm_bytes *file, uint64_t place)
{
    struct gm_column *out = &lane->columns[1];
    out->file = file;
    out->place = place;
    out->failed = file->why != 0;
    return out;
}

static void end_file(struct gm_saved *lane, struct gm_bytes *file)
{
    gm_columns_flush(&lane->columns[1], 1);
    lane->columns[1].file = &lane->file;
    gm_bytes_note(&lane->file, gm_bytes_close(file));
}

static void write_group(const struct group *group, struct gm_saved *lane, const char *path)
{
    struct array arrays[LONGEST];
    const size_t count = list_arrays(group, arrays);
    struct gm_bytes file = gm_bytes_of(open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    struct gm_column *out = begin_file(lane, &file, 0);
    write_head(group, arrays, count, out);
    for (size_t i = 0; i < count; i++) {
        const uint64_t size = bytes_of(&arrays[i]);
        gm_column_put(out, &size, sizeof size);
        write_array(group, &arrays[i], out);
    }
    gm_column_print(out, "\n</AppendedData>\n</VTKFile>\n");
    end_file(lane, &file);
    if (file.why != 0) { /* not the half of a row */
        unlink(path);
    }
}

static void begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected)
{
    (void)run, (void)expected;
    char message[GM_MESSAGE];
    const bool made = gm_folder_make(saving->folder, message);
    lane->file = gm_bytes_of(made ? gm_part_file(saving->part, lane->index, false) : -1);
    gm_lines_open(&lane->columns[0], &lane->file, lane->rows);
    lane->columns[1].file = &lane->file;
    gm_column_open(&lane->columns[1]);
}

/* The length of the folder's path, which the list leaves out. */
static size_t front_of(const struct gm_saving *saving)
{
    return (size_t)(basename(saving->path) - saving->path);
}

/* Room for a path and the names below it: a longer one cannot be opened. */
enum { PATH = 4096 + 128 };

/* The file of a row's points. Returns path. */
static const char *path_of(const struct gm_saving *saving, const struct gm_saved *lane, uint64_t row,
                           const char *ending, char path[PATH])
{
    char prefix[40] = "";
    if (saving->count > 1) {
        snprintf(prefix, sizeof prefix, "lane%zu-", lane->index);
    }
    snprintf(path, PATH, "%s/%s%06" PRIu64 "%s.vtu", saving->folder, prefix, row, ending);
    return path;
}

/* The files of a row. */
static const struct {
    enum gm_support support;
    const char *ending;
} groups[] = {{GM_ON_RUN, ""}, {GM_ON_BODIES, ""}, {GM_ON_NODES, ""}, {GM_ON_TRACERS, "-tracers"}};

static void row_of_files(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    const size_t front = front_of(saving);
    struct gm_column *lines = &lane->columns[0];
    int parts = 0;
    for (size_t i = 0; i < GM_COUNT(groups) && lane->file.why == 0; i++) {
        struct group group;
        if (!group_of(lane, run, groups[i].support, &group)) {
            continue;
        }
        char path[PATH];
        write_group(&group, lane, path_of(saving, lane, lane->rows, groups[i].ending, path));
        gm_column_print(lines, "%s<DataSet timestep=\"%.17g\" part=\"%zu\" file=\"", parts > 0 ? " " : "",
                        run->t, 2 * lane->index + (size_t)(parts > 0));
        gm_column_put(lines, path + front, strlen(path + front));
        gm_column_print(lines, "\"/>");
        parts++;
    }
    /* one line per row, which exists with its files */
    lines->failed = lane->file.why != 0;
    gm_column_put(lines, "\n", 1);
    gm_columns_flush(lines, 1);
}

/* The groups of a lane with their arrays, and the offsets in the file of all rows. */
struct places {
    size_t groups, counts[GM_COUNT(groups)];
    struct group group[GM_COUNT(groups)];
    struct array arrays[GM_COUNT(groups)][LONGEST];
    uint64_t head, row; /* bytes of the arrays that do not change, and of a row of the others */
};

static void find_places(const struct gm_saved *lane, const struct gm_run *run, struct places *places)
{
    *places = (struct places){0};
    for (size_t g = 0; g < GM_COUNT(groups); g++) {
        if (!group_of(lane, run, groups[g].support, &places->group[places->groups])) {
            continue;
        }
        struct array *arrays = places->arrays[places->groups];
        const size_t all = list_arrays(&places->group[places->groups], arrays);
        size_t count = 0;
        for (size_t i = 0; i < all; i++) {
            if (arrays[i].content == TIME || arrays[i].content == OFFSETS || arrays[i].content == TYPES) {
                continue; /* the list has the time, the topology's name the types */
            }
            arrays[count++] = arrays[i];
            *(arrays[i].fixed ? &places->head : &places->row) += bytes_of(&arrays[i]);
        }
        places->counts[places->groups++] = count;
    }
}

static uint64_t place_of_row(const struct places *places, uint64_t row)
{
    return row > 0 ? places->head + row * places->row : 0;
}

/* The file of a lane's rows. Returns path. */
static const char *rows_path_of(const struct gm_saving *saving, const struct gm_saved *lane, char path[PATH])
{
    snprintf(path, PATH, "%s/lane%zu.bin", saving->folder, lane->index);
    return path;
}

/* An array that begins at a place of the file of that name. */
static void put_item(struct gm_column *lines, const struct group *group, const struct array *array,
                     uint64_t place, const char *name)
{
    static const char *const topologies[] = {
        [POINTS] = "Polyvertex", [LINE] = "Polyline", [TRIANGLES] = "Triangle"};
    static const char *const centres[] = {[FIELD] = "Grid", [POINT] = "Node", [CELL] = "Cell"};
    const char *element = "Attribute";
    size_t tuples = array->tuples, components = array->components;
    if (array->section == TOPOLOGY) {
        element = "Topology";
        tuples = group->cells;
        components = array->tuples / tuples;
        gm_column_print(lines,
                        "<Topology TopologyType=\"%s\" NumberOfElements=\"%zu\" NodesPerElement=\"%zu\">",
                        topologies[group->shape], tuples, components);
    } else if (array->section == PLACES) {
        element = "Geometry";
        gm_column_print(lines, "<Geometry GeometryType=\"XYZ\">");
    } else {
        gm_column_print(lines, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">", array->name,
                        components > 1 ? "Vector" : "Scalar", centres[array->section]);
    }
    gm_column_print(lines,
                    "<DataItem Dimensions=\"%zu %zu\" NumberType=\"%s\" Precision=\"8\" Format=\"Binary\" "
                    "Endian=\"Little\" Seek=\"%" PRIu64 "\">",
                    tuples, components, array->section == TOPOLOGY ? "Int" : "Float", place);
    gm_column_put(lines, name, strlen(name));
    gm_column_print(lines, "</DataItem></%s>", element);
}

/* The line of a row. */
static void put_row(struct gm_saved *lane, const struct places *places, double t, const char *name)
{
    struct gm_column *lines = &lane->columns[0];
    uint64_t at[] = {places->head + lane->rows * places->row, 0}; /* offsets of changing and fixed arrays */
    gm_column_print(
        lines,
        "<Grid Name=\"row\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"%.17g\"/>", t);
    for (size_t g = 0; g < places->groups; g++) {
        gm_column_print(lines, "<Grid Name=\"%s\"><Time Value=\"%.17g\"/>",
                        places->group[g].support == GM_ON_TRACERS ? "tracers" : "state", t);
        for (size_t i = 0; i < places->counts[g]; i++) {
            const struct array *array = &places->arrays[g][i];
            put_item(lines, &places->group[g], array, at[array->fixed], name);
            at[array->fixed] += bytes_of(array);
        }
        gm_column_print(lines, "</Grid>");
    }
    gm_column_print(lines, "</Grid>\n");
    gm_columns_flush(lines, 1);
}

static void row_of_one_file(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    const int first = lane->rows == 0;
    struct places places;
    char path[PATH];
    find_places(lane, run, &places);
    struct gm_bytes file = gm_bytes_of(
        open(rows_path_of(saving, lane, path), O_WRONLY | O_CLOEXEC | (first ? O_CREAT | O_TRUNC : 0), 0666));
    struct gm_column *out = begin_file(lane, &file, place_of_row(&places, lane->rows));
    for (int fixed = first; fixed >= 0; fixed--) {
        for (size_t g = 0; g < places.groups; g++) {
            for (size_t i = 0; i < places.counts[g]; i++) {
                const struct array *array = &places.arrays[g][i];
                if (array->fixed == (fixed == 1)) {
                    write_array(&places.group[g], array, out);
                }
            }
        }
    }
    end_file(lane, &file);
    if (lane->file.why == 0) {
        put_row(lane, &places, run->t, path + front_of(saving));
    }
}

static bool is_of_files(const struct gm_saving *saving)
{
    return strcmp(strrchr(saving->path, '.'), gm_data_format_pvd.ending) == 0;
}

/* Removes the rows from `from` to `last`, which may be incomplete; the last file's folder goes too. */
static void remove_rows(const struct gm_saving *saving, const struct gm_saved *lane, uint64_t from,
                        uint64_t last)
{
    char path[PATH];
    struct places places;
    if (!is_of_files(saving)) {
        find_places(lane, NULL, &places);
        rows_path_of(saving, lane, path);
        if (from == 0) {
            unlink(path);
        } else if (truncate(path, (off_t)place_of_row(&places, from)) != 0) {
            return; /* a file longer than its rows can still be read */
        }
    }
    for (uint64_t row = from; row <= last && is_of_files(saving); row++) {
        for (size_t i = 0; i < GM_COUNT(groups); i++) {
            unlink(path_of(saving, lane, row, groups[i].ending, path));
        }
    }
    rmdir(saving->folder);
}

/* Writes the run's description as a comment; XML forbids "--" there, so the second is escaped as in JSON. */
static void put_meta(const char *meta, FILE *file)
{
    fputs("<!-- ", file);
    for (const char *at = meta; *at; at++) {
        const bool second = *at == '-' && at > meta && at[-1] == '-';
        fputs(second ? "\\u002d" : (char[]){*at, '\0'}, file);
    }
    fputs(" -->\n", file);
}

static bool copy_lines(const struct gm_saving *saving, const struct gm_saved *lane, FILE *file)
{
    char block[1 << 14];
    struct gm_bytes source = gm_bytes_of(gm_part_file(saving->part, lane->index, false));
    ssize_t got = source.why == 0 ? 1 : 0;
    while (got > 0) {
        got = read(source.file, block, sizeof block);
        gm_bytes_note(&source, got <= 0 ? got == 0 : fwrite(block, 1, (size_t)got, file) == (size_t)got);
        got = source.why == 0 ? got : 0;
    }
    return gm_bytes_close(&source);
}

static bool list(const struct gm_saving *saving, FILE *file)
{
    const bool files = is_of_files(saving);
    fputs(files ? "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                  "byte_order=\"LittleEndian\">\n<Collection>\n"
                : "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n",
          file);
    for (size_t i = 0; i < saving->begun; i++) {
        const struct gm_saved *lane = &saving->lanes[i];
        if (!files) {
            fprintf(file, "<Grid Name=\"lane%zu\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
                    lane->index);
        }
        if (lane->meta) { /* not before the lane has ended */
            put_meta(lane->meta, file);
        }
        if (!copy_lines(saving, lane, file)) {
            return false;
        }
        fputs(files ? "" : "</Grid>\n", file);
    }
    fputs(files ? "</Collection>\n</VTKFile>\n" : "</Domain>\n</Xdmf>\n", file);
    return !ferror(file);
}

static void cut(const struct gm_saving *saving, struct gm_saved *lane)
{
    const uint64_t begun = lane->rows;
    lane->rows = gm_lines_cut(&lane->columns[0]);
    remove_rows(saving, lane, lane->rows, begun);
}

static bool drop(const struct gm_saving *saving, struct gm_saved *lane)
{
    /* a line of the list is short beside a row's file */
    const uint64_t rows = lane->rows, part = (rows + 63) / 64;
    if (rows == part) {
        return false;
    }
    struct gm_column lines = {0};
    struct gm_bytes file = gm_bytes_of(gm_part_file(saving->part, lane->index, false));
    gm_lines_open(&lines, &file, rows - part);
    if (file.why == 0) {
        remove_rows(saving, lane, rows - part, rows);
        lane->rows = rows - part;
    }
    gm_column_close(&lines);
    return gm_bytes_close(&file);
}

const struct gm_data_format gm_data_format_pvd = {.ending = ".pvd",
                                                  .pictures = true,
                                                  .begin = begin,
                                                  .row = row_of_files,
                                                  .cut = cut,
                                                  .list = list,
                                                  .drop = drop};
const struct gm_data_format gm_data_format_xdmf = {.ending = ".xdmf",
                                                   .pictures = true,
                                                   .begin = begin,
                                                   .row = row_of_one_file,
                                                   .cut = cut,
                                                   .list = list,
                                                   .drop = drop};
