/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States for VTK: FILE.pvd is a list of times and files; these lie in the folder FILE, one .vtu file a row
   for the mesh, the line or the bodies, and one for the tracers. "VTK XML Formats", vtk.org; raw appended
   data, lowest byte first. The file of a lane in the making holds its lines of the list.

   FILE.xdmf is a list of times, too, and of places in one file a lane, laneN.bin in the folder FILE, which has the
   arrays that do not change once, and then the others, row by row. "XDMF Model and Format", xdmf.org. */
#include <errno.h>
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

/* An array of a file: the entries of its head, and its writer. */
struct array {
    enum section section;
    const char *name, *type;
    size_t components, tuples, item; /* item: bytes of a number */
    bool fixed;                      /* the same in all rows */
    const struct gm_quantity *quantity;
    void (*write)(const struct group *group, FILE *file);
};

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

/* The first quantity on a support that is not a coordinate, or NULL. */
static const struct gm_quantity *first_on(const struct gm_saved *lane, enum gm_support support)
{
    for (size_t i = 0; i < lane->count; i++) {
        if (lane->quantities[i].support == support && lane->quantities[i].axis == 0) {
            return &lane->quantities[i];
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
        group->corners = first_on(lane, GM_ON_CELLS);
        group->shape = group->corners ? TRIANGLES : LINE;
        group->cells = group->corners ? group->corners->count : 1;
        group->height = group->corners ? NULL : first_on(lane, support);
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
static bool write_apart(const struct group *group, const struct gm_quantity *quantity, size_t components,
                        FILE *file)
{
    const size_t width = quantity->width, vertices = group->axes[0]->count;
    double *values = malloc(width * vertices * sizeof *values);
    if (!values) {
        return false;
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
        fwrite(vector, sizeof *vector, components, file);
    }
    free(values);
    return true;
}

/* Writes coordinates point by point. Quantities may have to be derived one by one, so x, y and z are
   collected first. */
static void write_places(const struct group *group, FILE *file)
{
    if (group->apart) {
        write_apart(group, group->axes[0], SOLID, file);
        return;
    }
    double *places = calloc(group->points, SOLID * sizeof *places);
    if (!places) {
        return; /* the file is then too short, which is seen */
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
    fwrite(places, sizeof *places, SOLID * group->points, file);
    free(places);
}

static void write_whole(FILE *file, int64_t number)
{
    fwrite(&number, sizeof number, 1, file);
}

static void write_connectivity(const struct group *group, FILE *file)
{
    const size_t corners = group->corners ? group->corners->width * group->cells : group->points;
    const double *values = group->corners ? values_of(group, group->corners) : NULL;
    for (size_t k = 0; k < corners; k++) {
        write_whole(file, values && !group->apart ? (int64_t)values[k] : (int64_t)k);
    }
}

static void write_offsets(const struct group *group, FILE *file)
{
    for (size_t k = 1; k <= group->cells; k++) {
        write_whole(file, (int64_t)(group->corners ? group->corners->width * k : group->points));
    }
}

static void write_types(const struct group *group, FILE *file)
{
    const int types[] = {[POINTS] = VTK_POLY_VERTEX, [LINE] = VTK_POLY_LINE, [TRIANGLES] = VTK_TRIANGLE};
    for (size_t k = 0; k < group->cells; k++) {
        fputc(types[group->shape], file);
    }
}

static void write_time(const struct group *group, FILE *file)
{
    fwrite(&group->run->t, sizeof group->run->t, 1, file);
}

static void write_values(const struct group *group, const struct array *array, FILE *file)
{
    const struct gm_quantity *quantity = array->quantity;
    if (group->apart && array->section == POINT) {
        write_apart(group, quantity, array->components, file);
        return;
    }
    const double *values = values_of(group, quantity);
    if (array->components == quantity->width) {
        fwrite(values, sizeof *values, array->components * array->tuples, file);
        return;
    }
    for (size_t k = 0; k < array->tuples; k++) {
        double vector[SOLID] = {0};
        memcpy(vector, values + quantity->width * k, quantity->width * sizeof *values);
        fwrite(vector, sizeof *vector, SOLID, file);
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
    arrays[count++] = (struct array){FIELD, "TimeValue", "Float64", 1, 1, 8, false, NULL, write_time};
    for (size_t i = 0; i < group->lane->count; i++) {
        const struct gm_quantity *quantity = &group->lane->quantities[i];
        const enum section section = section_of(group, quantity);
        if (section != SECTIONS) {
            arrays[count++] = (struct array){
                section,
                quantity->name,
                "Float64",
                quantity->width > 1 ? SOLID : 1,
                section == POINT && group->apart ? group->points : quantity->count * group->lane->members,
                8,
                quantity->fixed,
                quantity,
                NULL};
        }
    }
    const size_t corners = group->corners ? group->corners->width * group->cells : group->points;
    const bool stays = !group->height && group->axes[0]->fixed;
    arrays[count++] =
        (struct array){PLACES, "Points", "Float64", SOLID, group->points, 8, stays, NULL, write_places};
    arrays[count++] =
        (struct array){TOPOLOGY, "connectivity", "Int64", 1, corners, 8, true, NULL, write_connectivity};
    arrays[count++] =
        (struct array){TOPOLOGY, "offsets", "Int64", 1, group->cells, 8, true, NULL, write_offsets};
    arrays[count++] = (struct array){TOPOLOGY, "types", "UInt8", 1, group->cells, 1, true, NULL, write_types};
    return count;
}

static uint64_t bytes_of(const struct array *array)
{
    return array->components * array->tuples * array->item;
}

static void write_head(const struct group *group, const struct array *arrays, size_t count, FILE *file)
{
    static const char *const names[] = {"FieldData", "PointData", "CellData", "Points", "Cells"};
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
          "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n",
          file);
    for (int section = FIELD; section < SECTIONS; section++) {
        uint64_t offset = 0;
        fprintf(file, "<%s>\n", names[section]);
        for (size_t i = 0; i < count; i++) {
            if ((int)arrays[i].section == section) {
                fprintf(file,
                        "<DataArray type=\"%s\" Name=\"%s\" %s=\"%zu\" format=\"appended\" offset=\"%" PRIu64
                        "\"/>\n",
                        arrays[i].type, arrays[i].name,
                        section == FIELD ? "NumberOfTuples" : "NumberOfComponents",
                        section == FIELD ? arrays[i].tuples : arrays[i].components, offset);
            }
            offset += sizeof offset + bytes_of(&arrays[i]);
        }
        fprintf(file, "</%s>\n", names[section]);
        if (section == FIELD) {
            fprintf(file, "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n", group->points,
                    group->cells);
        }
    }
    fputs("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_", file);
}

/* Returns false with errno. */
static bool write_array(const struct group *group, const struct array *array, FILE *file)
{
    const off_t before = ftello(file);
    if (array->write) {
        array->write(group, file);
    } else {
        write_values(group, array, file);
    }
    errno = ferror(file) ? errno : ENOMEM;
    return !ferror(file) && ftello(file) - before == (off_t)bytes_of(array);
}

static bool write_group(const struct group *group, const char *path)
{
    struct array arrays[LONGEST];
    const size_t count = list_arrays(group, arrays);
    FILE *file = fopen(path, "wbe");
    if (!file) {
        return false;
    }
    write_head(group, arrays, count, file);
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        const uint64_t size = bytes_of(&arrays[i]);
        fwrite(&size, sizeof size, 1, file);
        good = write_array(group, &arrays[i], file) && good;
    }
    fputs("\n</AppendedData>\n</VTKFile>\n", file);
    int why = errno;
    if (fclose(file) != 0 && good) {
        why = errno;
        good = false;
    }
    if (!good) { /* not the half of a row */
        unlink(path);
    }
    errno = why;
    return good;
}

static bool begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected)
{
    (void)run, (void)expected;
    char message[GM_MESSAGE];
    const bool made = gm_folder_make(saving->folder, message);
    lane->file = made ? gm_part_file(saving->part, lane->index, false) : -1;
    return lane->file >= 0 && gm_lines_open(&lane->columns[0], lane->file, lane->rows);
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

static bool row_of_files(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    const char *slash = strrchr(saving->path, '/');
    /* the length of the folder's path, which the list leaves out */
    const size_t front = slash ? (size_t)(slash + 1 - saving->path) : 0;
    bool good = true;
    errno = ENOMEM; /* the reason if no call for a file gives another one */
    int parts = 0;
    for (size_t i = 0; i < GM_COUNT(groups) && good; i++) {
        struct group group;
        if (!group_of(lane, run, groups[i].support, &group)) {
            continue;
        }
        char path[PATH];
        good = write_group(&group, path_of(saving, lane, lane->rows, groups[i].ending, path)) &&
               gm_column_print(&lane->columns[0], "%s<DataSet timestep=\"%.17g\" part=\"%zu\" file=\"",
                               parts > 0 ? " " : "", run->t, 2 * lane->index + (size_t)(parts > 0)) &&
               gm_column_put(&lane->columns[0], path + front, strlen(path + front)) &&
               gm_column_print(&lane->columns[0], "\"/>");
        parts++;
    }
    /* one line per row, which exists with its files */
    return good && gm_column_put(&lane->columns[0], "\n", 1) && gm_column_flush(&lane->columns[0]);
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
            if (arrays[i].write == write_time || arrays[i].write == write_offsets ||
                arrays[i].write == write_types) {
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
static bool put_item(struct gm_column *lines, const struct group *group, const struct array *array,
                     uint64_t place, const char *name)
{
    static const char *const topologies[] = {
        [POINTS] = "Polyvertex", [LINE] = "Polyline", [TRIANGLES] = "Triangle"};
    static const char *const centres[] = {[FIELD] = "Grid", [POINT] = "Node", [CELL] = "Cell"};
    const char *element = "Attribute";
    size_t tuples = array->tuples, components = array->components;
    bool good = true;
    if (array->section == TOPOLOGY) {
        element = "Topology";
        tuples = group->cells;
        components = array->tuples / tuples;
        good = gm_column_print(
            lines, "<Topology TopologyType=\"%s\" NumberOfElements=\"%zu\" NodesPerElement=\"%zu\">",
            topologies[group->shape], tuples, components);
    } else if (array->section == PLACES) {
        element = "Geometry";
        good = gm_column_print(lines, "<Geometry GeometryType=\"XYZ\">");
    } else {
        good = gm_column_print(lines, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">",
                               array->name, components > 1 ? "Vector" : "Scalar", centres[array->section]);
    }
    return good &&
           gm_column_print(
               lines,
               "<DataItem Dimensions=\"%zu %zu\" NumberType=\"%s\" Precision=\"8\" Format=\"Binary\" "
               "Endian=\"Little\" Seek=\"%" PRIu64 "\">",
               tuples, components, array->section == TOPOLOGY ? "Int" : "Float", place) &&
           gm_column_put(lines, name, strlen(name)) && gm_column_print(lines, "</DataItem></%s>", element);
}

/* The line of a row. */
static bool put_row(struct gm_saved *lane, const struct places *places, double t, const char *name)
{
    struct gm_column *lines = &lane->columns[0];
    uint64_t at[] = {places->head + lane->rows * places->row, 0}; /* offsets of changing and fixed arrays */
    bool good = gm_column_print(
        lines,
        "<Grid Name=\"row\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"%.17g\"/>", t);
    for (size_t g = 0; g < places->groups && good; g++) {
        good = gm_column_print(lines, "<Grid Name=\"%s\"><Time Value=\"%.17g\"/>",
                               places->group[g].support == GM_ON_TRACERS ? "tracers" : "state", t);
        for (size_t i = 0; i < places->counts[g] && good; i++) {
            const struct array *array = &places->arrays[g][i];
            good = put_item(lines, &places->group[g], array, at[array->fixed], name);
            at[array->fixed] += bytes_of(array);
        }
        good = good && gm_column_print(lines, "</Grid>");
    }
    return good && gm_column_print(lines, "</Grid>\n") && gm_column_flush(lines);
}

static bool row_of_one_file(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    struct places places;
    find_places(lane, run, &places);
    errno = ENOMEM;
    char path[PATH];
    FILE *file = fopen(rows_path_of(saving, lane, path), lane->rows > 0 ? "r+be" : "wbe");
    bool good = file && fseeko(file, (off_t)place_of_row(&places, lane->rows), SEEK_SET) == 0;
    for (int fixed = lane->rows == 0; fixed >= 0; fixed--) {
        for (size_t g = 0; g < places.groups; g++) {
            for (size_t i = 0; i < places.counts[g] && good; i++) {
                const struct array *array = &places.arrays[g][i];
                good = array->fixed != (fixed == 1) || write_array(&places.group[g], array, file);
            }
        }
    }
    const int why = errno;
    if (file && fclose(file) != 0 && good) {
        good = false;
    } else {
        errno = why;
    }
    const char *slash = strrchr(saving->path, '/');
    good = good && put_row(lane, &places, run->t, path + (slash ? slash + 1 - saving->path : 0));
    return good;
}

static bool is_of_files(const struct gm_saving *saving)
{
    return strcmp(strrchr(saving->path, '.'), gm_data_format_pvd.ending) == 0;
}

static void shorten(const struct gm_saving *saving, const struct gm_saved *lane, uint64_t rows)
{
    struct places places;
    find_places(lane, NULL, &places);
    char path[PATH];
    rows_path_of(saving, lane, path);
    if (rows == 0) {
        unlink(path);
    } else if (truncate(path, (off_t)place_of_row(&places, rows)) != 0) {
        return; /* a file longer than its rows can still be read */
    }
}

/* Removes the rows from `from` to `last`, which may be incomplete; the last file's folder goes too. */
static void remove_rows(const struct gm_saving *saving, const struct gm_saved *lane, uint64_t from,
                        uint64_t last)
{
    if (!is_of_files(saving)) {
        shorten(saving, lane, from);
    }
    for (uint64_t row = from; row <= last && is_of_files(saving); row++) {
        for (size_t i = 0; i < GM_COUNT(groups); i++) {
            char path[PATH];
            unlink(path_of(saving, lane, row, groups[i].ending, path));
        }
    }
    rmdir(saving->folder);
}

/* Writes the run's description as a comment; XML forbids "--" there, so the second is escaped as in JSON. */
static bool put_meta(const char *meta, FILE *file)
{
    fputs("<!-- ", file);
    for (const char *at = meta; *at; at++) {
        const bool second = *at == '-' && at > meta && at[-1] == '-';
        fputs(second ? "\\u002d" : (char[]){*at, '\0'}, file);
    }
    return fputs(" -->\n", file) >= 0 && !ferror(file);
}

static bool copy_lines(const struct gm_saving *saving, const struct gm_saved *lane, FILE *file)
{
    char block[1 << 14];
    const int source = gm_part_file(saving->part, lane->index, false);
    ssize_t got = 0;
    bool good = source >= 0;
    while (good && (got = read(source, block, sizeof block)) > 0) {
        good = fwrite(block, 1, (size_t)got, file) == (size_t)got;
    }
    if (source >= 0) {
        close(source);
    }
    return good && got == 0;
}

static bool list(const struct gm_saving *saving, FILE *file)
{
    const bool files = is_of_files(saving);
    bool good = fputs(files ? "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                              "byte_order=\"LittleEndian\">\n<Collection>\n"
                            : "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n",
                      file) >= 0;
    for (size_t i = 0; i < saving->begun && good; i++) {
        const char *meta = saving->lanes[i].meta; /* not before the lane has ended */
        if (!files) {
            fprintf(file, "<Grid Name=\"lane%zu\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
                    saving->lanes[i].index);
        }
        good = (!meta || put_meta(meta, file)) && copy_lines(saving, &saving->lanes[i], file) &&
               (files || fputs("</Grid>\n", file) >= 0);
    }
    return good && fputs(files ? "</Collection>\n</VTKFile>\n" : "</Domain>\n</Xdmf>\n", file) >= 0;
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
    struct gm_column lines;
    const int file = rows > part ? gm_part_file(saving->part, lane->index, false) : -1;
    const bool good = file >= 0 && gm_lines_open(&lines, file, rows - part);
    if (good) {
        gm_column_close(&lines);
        remove_rows(saving, lane, rows - part, rows);
        lane->rows = rows - part;
    }
    if (file >= 0) {
        close(file);
    }
    return good;
}

const struct gm_data_format gm_data_format_pvd = {
    .ending = ".pvd", .begin = begin, .row = row_of_files, .cut = cut, .list = list, .drop = drop};
const struct gm_data_format gm_data_format_xdmf = {
    .ending = ".xdmf", .begin = begin, .row = row_of_one_file, .cut = cut, .list = list, .drop = drop};
