// Blocks in a list, each behind an aligned header; destroyed newest first.
#define _DEFAULT_SOURCE // madvise
#include "core/base/arena.h"

#include <setjmp.h>
#include <sys/mman.h>

// [bytes]; PAGE: of the large ones
enum { ALIGNMENT = 64, PAGE = 1 << 21, LARGE = PAGE / 4, MANY = 16 * PAGE };

typedef struct block {
    struct block *next;
    void *start;             // of the memory taken for it; NULL: it is in the pages of an older block
    size_t mapped;           // its size where it is whole pages of the system; 0: malloc's
    void (*release)(void *); // NULL for plain memory
    void *object;
} block;

typedef struct guard {
    jmp_buf here;
    struct guard *outer;
} guard;

struct bough_arena {
    block *newest;
    size_t bytes;
    char *rest;                         // unused end of the mapped pages, all zero
    size_t left;                        // its size [bytes]
    guard *guard;                       // the innermost; NULL: none, or a child
    bough_arena *parent, *child, *next; // first child; next child of the same parent
};

// -- life -----------------------------------------------------------------------------------------

bough_arena *bough_arena_create(void) { return calloc(1, sizeof(bough_arena)); }

_Noreturn void bough_arena_leave(bough_arena *arena) {
    // guards are of the outermost arena
    while (arena->parent) arena = arena->parent;
    if (arena->guard) longjmp(arena->guard->here, 1);
    fputs("bough: error: memory is exhausted\n", stderr);
    exit(bough_exit_code(BOUGH_OUT_OF_MEMORY));
}

bough_arena *bough_arena_child(bough_arena *parent) {
    bough_arena *child = bough_arena_create();
    if (!child) bough_arena_leave(parent);
    child->parent = parent;
    child->next = parent->child;
    parent->child = child;
    return child;
}

// Removes the arena from the list of its parent's children.
static void leave_parent(bough_arena *arena) {
    bough_arena **at = &arena->parent->child;
    while (*at != arena) at = &(*at)->next;
    *at = arena->next;
}

void bough_arena_destroy(bough_arena *arena) {
    if (!arena) return;
    // children first: what they release may use memory of the parent
    while (arena->child) bough_arena_destroy(arena->child);
    if (arena->parent) leave_parent(arena);
    for (block *b = arena->newest, *next; b; b = next) {
        next = b->next;
        if (b->release) b->release(b->object);
        if (b->mapped)
            munmap(b->start, b->mapped);
        else
            free(b->start);
    }
    free(arena);
}

// -- guard ----------------------------------------------------------------------------------------

static bough_status out_of_memory(void) { return bough_fail(BOUGH_OUT_OF_MEMORY, "memory is exhausted"); }

bough_status bough_arena_guard(bough_arena *arena, bough_status (*work)(bough_arena *arena, void *self),
                               void *self) {
    // guards nest: the innermost call of bough_arena_guard returns
    guard inner = {.outer = arena->guard};
    arena->guard = &inner;
    bough_status status = setjmp(inner.here) == 0 ? work(arena, self) : out_of_memory();
    arena->guard = inner.outer;
    return status;
}

bough_status bough_arena_use(bough_status (*work)(bough_arena *arena, void *self), void *self) {
    bough_arena *arena = bough_arena_create();
    bough_status status = arena ? bough_arena_guard(arena, work, self) : out_of_memory();
    bough_arena_destroy(arena);
    return status;
}

// -- blocks ---------------------------------------------------------------------------------------

// Zeroed memory that begins with a large page. *size [bytes]: what is needed, then what is mapped. NULL: the
// system has none.
static void *map_pages(size_t *size) {
#ifndef __SANITIZE_ADDRESS__ // which watches malloc
    size_t wanted = (*size + PAGE - 1) / PAGE * PAGE, all = wanted + PAGE;
    char *from = mmap(NULL, all, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (from == MAP_FAILED) return NULL;
    // what is before the first large page and behind the last goes back
    size_t before = (PAGE - (size_t)from % PAGE) % PAGE;
    if (before > 0) munmap(from, before);
    if (before < PAGE) munmap(from + before + wanted, PAGE - before);
    (void)madvise(from + before, wanted, MADV_NOHUGEPAGE); // also where the system has them everywhere
    *size = wanted;
    return from + before;
#else
    (void)size;
    return NULL;
#endif
}

// A large block behind others in pages that are mapped, *mapped 0, or in new ones. NULL: the system has none.
static void *take_pages(bough_arena *arena, size_t whole, size_t *mapped) {
    bool fits = whole <= arena->left;
    size_t size = whole < MANY ? MANY : whole;
    char *start = fits ? arena->rest : map_pages(&size);
    if (!start) return NULL;
    size_t left = (fits ? arena->left : size) - whole, before = (size_t)start % PAGE;
    if (fits || left > arena->left) arena->rest = start + whole, arena->left = left;
    *mapped = fits ? 0 : size;
    // large pages cause fewer faults than small ones, but are zeroed as a whole: the last one of a block is
    // large where the block ends in its last quarter
    size_t large = (before + whole + PAGE / 4) / PAGE * PAGE;
    (void)madvise(start - before, large, MADV_HUGEPAGE);
    return start;
}

// A block of `size` payload bytes behind an aligned header; NULL when there is none.
static block *push(bough_arena *arena, size_t size) {
    // no overflow in the rounding to whole pages
    if (size > (size_t)-1 - 2 * PAGE) return NULL;
    size_t whole = 2 * ALIGNMENT + (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT, mapped = 0;
    void *start = whole >= LARGE ? take_pages(arena, whole, &mapped) : NULL;
    bool own = !start || mapped > 0;
    if (!start) start = calloc(1, whole);
    if (!start) return NULL;
    size_t before = (ALIGNMENT - (size_t)start % ALIGNMENT) % ALIGNMENT;
    block *b = (block *)((char *)start + before);
    b->start = own ? start : NULL;
    b->mapped = mapped;
    b->next = arena->newest;
    arena->newest = b;
    arena->bytes += whole;
    return b;
}

void *bough_arena_take(bough_arena *arena, size_t size) {
    block *b = push(arena, size);
    if (!b) bough_arena_leave(arena);
    return (char *)b + ALIGNMENT;
}

double *bough_arena_doubles(bough_arena *arena, size_t count) {
    if (count > (size_t)-1 / sizeof(double)) bough_arena_leave(arena);
    return bough_arena_take(arena, count * sizeof(double));
}

void bough_arena_arrays(bough_arena *arena, size_t count, double **const *array) {
    for (; *array; array++) **array = bough_arena_doubles(arena, count);
}

void *bough_arena_grow(bough_arena *arena, void *items, int n, int *room, size_t size) {
    if (n < *room) return items;
    *room = *room ? 2 * *room : 16;
    void *more = bough_arena_take(arena, (size_t)*room * size);
    return n > 0 ? memcpy(more, items, (size_t)n * size) : more;
}

char *bough_arena_string(bough_arena *arena, const char *text) {
    if (!text) return NULL;
    return bough_arena_copy(arena, text, strlen(text) + 1);
}

void *bough_arena_copy(bough_arena *arena, const void *from, size_t size) {
    void *to = bough_arena_take(arena, size);
    if (size > 0) memcpy(to, from, size); // `from` may be NULL
    return to;
}

char *bough_arena_print(bough_arena *arena, const char *format, ...) {
    // once for the length, once for the text
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    size_t size = (size_t)vsnprintf(NULL, 0, format, arguments) + 1;
    char *text = bough_arena_take(arena, size);
    vsnprintf(text, size, format, again);
    va_end(again);
    va_end(arguments);
    return text;
}

void bough_arena_on_destroy(bough_arena *arena, void (*release)(void *), void *object) {
    block *b = push(arena, 0);
    if (!b) {
        // the object is released now, as the arena cannot keep it
        release(object);
        bough_arena_leave(arena);
    }
    b->release = release;
    b->object = object;
}

size_t bough_arena_bytes(const bough_arena *arena) { return arena->bytes; }
