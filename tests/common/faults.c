/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Preloaded into geomint: the n-th allocation or file call fails, as tests/shell/faults.py asks for.

       GM_FAULT=memory:17     the 17th allocation fails; memory:17+ that and all that follow
       GM_FAULT=memory:each   a child is forked for every allocation, which fails in it; its output is DIR/N.out and
                              DIR/N.err, and a line of DIR/0.ended is N, its wait status, and what was written before;
                              memory:each3.1 for every third, from the first one on
       GM_FAULT=files:17      the 17th call that touches a file fails, with ENOSPC or EIO
       GM_FAULT=streams:17    the 17th stream into memory that is closed says that it could not be; streams:each
       GM_FAULT_FOLDER=DIR    of these children
       GM_FAULT_COUNT=FILE    where the number of such calls is written at the end

   What counts are calls by the program itself, and allocations that SuiteSparse, GSL, libpng, libdeflate and
   FreeType make for it and report to it. Others (Mesa, fontconfig, ncurses, BLAS) may end a
   process whose allocations fail; nobody could do anything about that. The count runs on in processes that
   the program forks, and ends where another program is executed. A process that writes to places of a file more than any
   test needs is ended by SIGABRT: it would fill the disk. */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_RANGES = 32, ERROR_SEEN = 0x20 /* glibc's flag of a FILE */, MOST_WRITTEN = 1 << 28 /* bytes */ };

static struct range {
    uintptr_t from, to;
} ranges[MOST_RANGES]; /* of code whose calls count; the program's own is the first */
static size_t range_count;
static enum kind { NOTHING, MEMORY, FILES, STREAMS } kind;
static long wanted;
static bool from_there_on;
static long each, first;   /* a child for every each-th call, 0 for none, from this one on */
static atomic_long *count; /* shared with forked processes */

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t number, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static int add_ranges(struct dl_phdr_info *info, size_t size, void *data)
{
    static const char *const libraries[] = {
        "libcholmod",           "libumfpack", "libamd",     "libcolamd",   "libccolamd", "libcamd",
        "libsuitesparseconfig", "libpng16",   "libdeflate", "libfreetype", "libgsl",
    };
    (void)size;
    (void)data;
    const char *name = strrchr(info->dlpi_name, '/');
    bool ours = info->dlpi_name[0] == '\0' && range_count == 0; /* the program comes first */
    for (size_t i = 0; name && kind == MEMORY && i < sizeof libraries / sizeof libraries[0]; i++) {
        ours |= strncmp(name + 1, libraries[i], strlen(libraries[i])) == 0;
    }
    for (int i = 0; ours && i < info->dlpi_phnum && range_count < MOST_RANGES; i++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[i];
        if (part->p_type == PT_LOAD && (part->p_flags & PF_X)) {
            const uintptr_t from = info->dlpi_addr + part->p_vaddr;
            ranges[range_count++] = (struct range){from, from + part->p_memsz};
        }
    }
    return 0;
}

__attribute__((constructor)) static void open_faults(void)
{
    char program[4096] = "";
    const char *fault = getenv("GM_FAULT"), *name = NULL;
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    name = length > 0 ? strrchr(program, '/') : NULL;
    if (!fault || !name || strcmp(name, "/geomint") != 0) {
        return;
    }
    void *shared = mmap(NULL, sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) {
        return;
    }
    count = shared;
    const char *number = strchr(fault, ':');
    wanted = number ? strtol(number + 1, NULL, 10) : 0;
    from_there_on = strchr(fault, '+') != NULL;
    if (number && strncmp(number, ":each", 5) == 0) {
        each = 1;
        sscanf(number, ":each%ld.%ld", &each, &first);
    }
    kind = fault[0] == 'm' ? MEMORY : fault[0] == 's' ? STREAMS : FILES;
    dl_iterate_phdr(add_ranges, NULL);
}

__attribute__((destructor)) static void close_faults(void)
{
    const char *path = getenv("GM_FAULT_COUNT");
    if (kind != NOTHING && path) {
        const int file = (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dprintf(file, "%ld\n", atomic_load(count));
        syscall(SYS_close, file);
    }
}

static int open_of_child(long n, const char *ending)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%ld.%s", getenv("GM_FAULT_FOLDER"), n, ending);
    return (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
}

/* True in a child that is forked here; false in its parent, when the child has ended. */
static bool is_child(long n)
{
    static int ended = -1;
    const long written = syscall(SYS_lseek, STDOUT_FILENO, 0, SEEK_CUR);
    ended = ended < 0 ? open_of_child(0, "ended") : ended;
    const pid_t child = fork();
    if (child == 0) {
        static atomic_long own;
        atomic_store(&own, n);
        count = &own;
        each = 0;
        syscall(SYS_dup3, open_of_child(n, "out"), STDOUT_FILENO, 0);
        syscall(SYS_dup3, open_of_child(n, "err"), STDERR_FILENO, 0);
        return true;
    }
    int status = -1;
    waitpid(child, &status, 0);
    dprintf(ended, "%ld %d %ld\n", n, status, written);
    return false;
}

/* Whether this call is the one that is to fail. */
static bool fails(enum kind which, const void *caller)
{
    const uintptr_t at = (uintptr_t)caller;
    if (kind != which || !count) {
        return false;
    }
    for (size_t i = 0; i < range_count; i++) {
        if (at >= ranges[i].from && at < ranges[i].to) {
            const long now = atomic_fetch_add(count, 1) + 1;
            if (each > 0) {
                return now % each == first % each && is_child(now);
            }
            return wanted > 0 && (from_there_on ? now >= wanted : now == wanted);
        }
    }
    return false;
}

#define NO_MEMORY_HERE fails(MEMORY, __builtin_return_address(0))

static void *none(void)
{
    errno = ENOMEM;
    return NULL;
}

void *malloc(size_t size)
{
    return NO_MEMORY_HERE ? none() : __libc_malloc(size);
}

void *calloc(size_t number, size_t size)
{
    return NO_MEMORY_HERE ? none() : __libc_calloc(number, size);
}

void *realloc(void *memory, size_t size)
{
    return NO_MEMORY_HERE ? none() : __libc_realloc(memory, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return NO_MEMORY_HERE ? none() : __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    void *found = NO_MEMORY_HERE ? NULL : __libc_memalign(alignment, size);
    if (!found) {
        return ENOMEM;
    }
    *memory = found;
    return 0;
}

char *strndup(const char *text, size_t length)
{
    length = strnlen(text, length);
    char *copy = NO_MEMORY_HERE ? none() : __libc_malloc(length + 1);
    if (copy) {
        memcpy(copy, text, length);
        copy[length] = '\0';
    }
    return copy;
}

char *strdup(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = NO_MEMORY_HERE ? none() : __libc_malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

int vasprintf(char **text, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    *text = length < 0 || NO_MEMORY_HERE ? NULL : __libc_malloc((size_t)length + 1);
    return *text ? vsnprintf(*text, (size_t)length + 1, format, arguments) : -1;
}

/* ISO C has no conversion between data and functions; POSIX lets the representation be copied. */
#define NEXT(function)                                                                                       \
    static __typeof__(function) *next;                                                                       \
    if (!next) {                                                                                             \
        void *found = dlsym(RTLD_NEXT, #function);                                                           \
        memcpy(&next, &found, sizeof next);                                                                  \
    }

FILE *fopencookie(void *cookie, const char *mode, cookie_io_functions_t functions)
{
    NEXT(fopencookie)
    return NO_MEMORY_HERE ? none() : next(cookie, mode, functions);
}

#define NO_FILE_HERE fails(FILES, __builtin_return_address(0))

static int refuse(int error)
{
    errno = error;
    return -1;
}

static int error_of(int flags)
{
    return (flags & O_ACCMODE) == O_RDONLY ? EIO : ENOSPC;
}

int open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = (flags & O_CREAT) ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    return NO_FILE_HERE ? refuse(error_of(flags)) : (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}

FILE *fopen(const char *path, const char *mode)
{
    NEXT(fopen)
    if (NO_FILE_HERE) {
        errno = mode[0] == 'r' ? EIO : ENOSPC;
        return NULL;
    }
    return next(path, mode);
}

FILE *fdopen(int descriptor, const char *mode)
{
    NEXT(fdopen)
    if (NO_FILE_HERE) {
        errno = EIO;
        return NULL;
    }
    return next(descriptor, mode);
}

ssize_t read(int descriptor, void *bytes, size_t size)
{
    return NO_FILE_HERE ? refuse(EIO) : syscall(SYS_read, descriptor, bytes, size);
}

ssize_t write(int descriptor, const void *bytes, size_t size)
{
    return NO_FILE_HERE ? refuse(ENOSPC) : syscall(SYS_write, descriptor, bytes, size);
}

ssize_t pread(int descriptor, void *bytes, size_t size, off_t offset)
{
    return NO_FILE_HERE ? refuse(EIO) : syscall(SYS_pread64, descriptor, bytes, size, offset);
}

ssize_t pwrite(int descriptor, const void *bytes, size_t size, off_t offset)
{
    static atomic_size_t written;
    if (atomic_fetch_add(&written, size) + size > MOST_WRITTEN) {
        abort();
    }
    return NO_FILE_HERE ? refuse(ENOSPC) : syscall(SYS_pwrite64, descriptor, bytes, size, offset);
}

int ftruncate(int descriptor, off_t size)
{
    return NO_FILE_HERE ? refuse(EIO) : (int)syscall(SYS_ftruncate, descriptor, size);
}

int fsync(int descriptor)
{
    return NO_FILE_HERE ? refuse(EIO) : (int)syscall(SYS_fsync, descriptor);
}

DIR *opendir(const char *path)
{
    NEXT(opendir)
    if (NO_FILE_HERE) {
        errno = EIO;
        return NULL;
    }
    return next(path);
}

int close(int descriptor)
{
    const int result = (int)syscall(SYS_close, descriptor);
    return NO_FILE_HERE ? refuse(EIO) : result;
}

int rename(const char *from, const char *to)
{
    return NO_FILE_HERE ? refuse(ENOSPC) : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int renameat(int folder, const char *from, int other, const char *to)
{
    return NO_FILE_HERE ? refuse(ENOSPC) : (int)syscall(SYS_renameat2, folder, from, other, to, 0);
}

int mkdir(const char *path, mode_t mode)
{
    return NO_FILE_HERE ? refuse(ENOSPC) : (int)syscall(SYS_mkdirat, AT_FDCWD, path, mode);
}

/* A stream into memory is no file. */
size_t fread(void *items, size_t size, size_t number, FILE *stream)
{
    NEXT(fread)
    if (fileno(stream) >= 0 && NO_FILE_HERE) {
        stream->_flags |= ERROR_SEEN;
        errno = EIO;
        return 0;
    }
    return next(items, size, number, stream);
}

/* The disk is full from now on, for this stream: what it holds in its buffer is lost. */
static void fill(FILE *stream)
{
    const int full = (int)syscall(SYS_openat, AT_FDCWD, "/dev/full", O_WRONLY, 0);
    syscall(SYS_dup3, full, fileno(stream), 0);
    syscall(SYS_close, full);
}

size_t fwrite(const void *items, size_t size, size_t number, FILE *stream)
{
    NEXT(fwrite)
    if (fileno(stream) >= 0 && NO_FILE_HERE) {
        fill(stream);
        stream->_flags |= ERROR_SEEN;
        errno = ENOSPC;
        return 0;
    }
    return next(items, size, number, stream);
}

int fflush(FILE *stream)
{
    NEXT(fflush)
    const bool full = NO_FILE_HERE;
    if (full && stream && fileno(stream) >= 0) {
        fill(stream);
    }
    return next(stream);
}

int fclose(FILE *stream)
{
    NEXT(fclose)
    const bool in_memory = fileno(stream) < 0;
    const bool full = fails(in_memory ? STREAMS : FILES, __builtin_return_address(0));
    if (full && !in_memory) {
        fill(stream);
    }
    const int result = next(stream);
    return full ? refuse(in_memory ? ENOMEM : ENOSPC) : result;
}
