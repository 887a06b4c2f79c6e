/* Loaded before the C library: fails the n-th call that changes a file below a folder.
 *
 * RMFS_FAULTS names a file of four 64-bit numbers that all processes share: calls so far, which call
 * fails, how (0 never, 1 that call, 2 that call and all later ones: the disk is full, 3 the process
 * is killed at it), and the error number. RMFS_FAULTS_BELOW names the folder.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

static volatile int64_t *state;
static const char *below;

__attribute__((constructor)) static void start(void) {
    const char *name = getenv("RMFS_FAULTS");
    below = getenv("RMFS_FAULTS_BELOW");
    if (!name || !below) return;
    int fd = open(name, O_RDWR);
    void *page = fd < 0 ? MAP_FAILED : mmap(0, 32, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (page != MAP_FAILED) state = page;
}

static int is_below(int folder, const char *path) {
    char whole[PATH_MAX * 2], link[64];
    if (path && path[0] == '/') return strncmp(path, below, strlen(below)) == 0;
    if (folder == AT_FDCWD) {
        if (!getcwd(whole, PATH_MAX)) return 0;
        strcat(whole, "/");
    } else {
        snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
        ssize_t n = readlink(link, whole, PATH_MAX);
        if (n < 0) return 0;
        whole[n] = 0;
        if (path) strcat(whole, "/");
    }
    return strncmp(whole, below, strlen(below)) == 0;
}

static int fails(int counts) {
    if (!state || !state[2] || !counts) return 0;
    int64_t call = __sync_add_and_fetch(&state[0], 1);
    int now = call == state[1] || (state[2] == 2 && call > state[1]);
    if (now && state[2] == 3) kill(getpid(), SIGKILL);
    if (now) errno = (int)state[3];
    return now;
}

#define REAL(name) ((typeof(&name))dlsym(RTLD_NEXT, #name))
#define OF_FILE(name, type, parameters, arguments) \
    type name parameters { \
        if (state && state[2] && fails(is_below(fd, 0))) return -1; \
        return REAL(name) arguments; \
    }

OF_FILE(write, ssize_t, (int fd, const void *data, size_t size), (fd, data, size))
OF_FILE(writev, ssize_t, (int fd, const struct iovec *data, int count), (fd, data, count))
OF_FILE(pwrite, ssize_t, (int fd, const void *data, size_t size, off_t at), (fd, data, size, at))
OF_FILE(pwrite64, ssize_t, (int fd, const void *data, size_t size, off64_t at), (fd, data, size, at))
OF_FILE(fsync, int, (int fd), (fd))
OF_FILE(fdatasync, int, (int fd), (fd))
OF_FILE(ftruncate, int, (int fd, off_t size), (fd, size))
OF_FILE(ftruncate64, int, (int fd, off64_t size), (fd, size))
OF_FILE(fchmod, int, (int fd, mode_t mode), (fd, mode))

int rename(const char *from, const char *to) {
    if (state && state[2] && fails(is_below(AT_FDCWD, to))) return -1;
    return REAL(rename)(from, to);
}
int renameat(int a, const char *from, int b, const char *to) {
    if (state && state[2] && fails(is_below(b, to))) return -1;
    return REAL(renameat)(a, from, b, to);
}
int renameat2(int a, const char *from, int b, const char *to, unsigned flags) {
    if (state && state[2] && fails(is_below(b, to))) return -1;
    return REAL(renameat2)(a, from, b, to, flags);
}
int mkdir(const char *path, mode_t mode) {
    if (state && state[2] && fails(is_below(AT_FDCWD, path))) return -1;
    return REAL(mkdir)(path, mode);
}
int mkdirat(int folder, const char *path, mode_t mode) {
    if (state && state[2] && fails(is_below(folder, path))) return -1;
    return REAL(mkdirat)(folder, path, mode);
}
int chmod(const char *path, mode_t mode) {
    if (state && state[2] && fails(is_below(AT_FDCWD, path))) return -1;
    return REAL(chmod)(path, mode);
}
int fchmodat(int folder, const char *path, mode_t mode, int flags) {
    if (state && state[2] && fails(is_below(folder, path))) return -1;
    return REAL(fchmodat)(folder, path, mode, flags);
}

#define OPENS(name, parameters, folder, arguments, given) \
    int name parameters { \
        mode_t mode = 0; \
        if (flags & (O_CREAT | O_TMPFILE)) { \
            va_list more; \
            va_start(more, flags); \
            mode = va_arg(more, mode_t); \
            va_end(more); \
        } \
        if (state && state[2] && (flags & (O_CREAT | O_TRUNC)) && fails(is_below(folder, path))) \
            return -1; \
        return REAL(name) given; \
    }

OPENS(open, (const char *path, int flags, ...), AT_FDCWD, , (path, flags, mode))
OPENS(open64, (const char *path, int flags, ...), AT_FDCWD, , (path, flags, mode))
OPENS(openat, (int fd, const char *path, int flags, ...), fd, , (fd, path, flags, mode))
OPENS(openat64, (int fd, const char *path, int flags, ...), fd, , (fd, path, flags, mode))
