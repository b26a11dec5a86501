// Preloaded by the tests: of the allocations that main() makes, number FAIL_AT finds no memory, and where
// FAIL_ALWAYS is set none behind it does.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stddef.h>
#include <stdlib.h>

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);

static long left = -1;  // allocations before the one that fails; below 0: none does
static int always = 0;
static int (*program)(int, char**, char**);

static int fails(void) {
  if (left < 0) return 0;
  if (left > 0 && --left > 0) return 0;
  if (!always) left = -1;
  errno = ENOMEM;
  return 1;
}

void* malloc(size_t size) { return fails() ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return fails() ? NULL : __libc_calloc(count, size); }
void* realloc(void* old, size_t size) { return fails() ? NULL : __libc_realloc(old, size); }
void* memalign(size_t alignment, size_t size) { return fails() ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** result, size_t alignment, size_t size) {
  *result = memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}

static int counted(int argc, char** argv, char** environment) {
  const char* at = getenv("FAIL_AT");
  always = getenv("FAIL_ALWAYS") != NULL;
  unsetenv("LD_PRELOAD");  // gnuplot has its own troubles
  if (at) left = atol(at);
  const int code = program(argc, argv, environment);
  left = -1;
  return code;
}

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void* stack_end) {
  typedef int (*Start)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void), void (*)(void), void*);
  program = main;
  return ((Start)dlsym(RTLD_NEXT, "__libc_start_main"))(counted, argc, argv, init, fini, rtld_fini, stack_end);
}
