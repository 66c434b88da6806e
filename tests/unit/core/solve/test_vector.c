// The vector operations that are bough's own against naive loops, at lengths around the blocks and lanes.
#include "tests/unit/check.h"

#include "core/solve/vector.h"

static const int lengths[] = {1, 7, 8, 63, 64, 65, 200};
enum { N_LENGTHS = sizeof lengths / sizeof *lengths, MOST = 200, COUNT = 5 };

typedef struct fixture {
    SUNContext context;
    N_Vector z, x[COUNT];
} fixture;

// Of both signs and never zero; the sine's argument is exact, fused multiply-add or not.
static double entry(int i, int k) { return sin(1.75 * i + 0.875 * k) + 0.1 * k + 0.01; }

static double at(N_Vector v, int i) { return bough_vector_data(v)[i]; }

static fixture create(int n) {
    fixture f;
    assert_int_equal(SUNContext_Create(NULL, &f.context), 0);
    f.z = bough_vector_create(n, f.context);
    assert_non_null(f.z);
    for (int k = 0; k < COUNT; k++) {
        f.x[k] = N_VClone(f.z);
        for (int i = 0; i < n; i++) bough_vector_data(f.x[k])[i] = entry(i, k);
    }
    return f;
}

static void destroy(fixture *f) {
    for (int k = 0; k < COUNT; k++) N_VDestroy(f->x[k]);
    N_VDestroy(f->z);
    SUNContext_Free(&f->context);
}

#define for_each_length(f, n)                                                                                \
    for (int which = 0, n; which < N_LENGTHS; which++)                                                       \
        if (n = lengths[which], f = create(n), 1)

TEST(data_is_aligned_and_cloned) {
    fixture f;
    for_each_length(f, n) {
        assert_int_equal((uintptr_t)bough_vector_data(f.x[0]) % 64, 0);
        assert_ptr_equal(N_VGetArrayPointer(f.x[0]), bough_vector_data(f.x[0]));
        assert_int_equal(N_VGetLength(f.x[0]), n);
        N_Vector empty = N_VCloneEmpty(f.x[0]);
        double other[MOST];
        assert_null(bough_vector_data(empty));
        N_VSetArrayPointer(other, empty);
        N_VConst(4, empty);
        check_near(other[n - 1], 4, 0, 0);
        N_VDestroy(empty); // must not free the caller's data
        destroy(&f);
    }
}

TEST(operations_are_those_of_naive_loops) {
    fixture f;
    for_each_length(f, n) {
        double squares = 0;
        N_VLinearSum(2, f.x[1], -3, f.x[2], f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), 2 * entry(i, 1) - 3 * entry(i, 2), 1e-14, 1e-14);
        N_VScale(-1.5, f.x[1], f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), -1.5 * entry(i, 1), 1e-15, 0);
        N_VConst(7, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), 7, 0, 0);
        for (int i = 0; i < n; i++) squares += pow(entry(i, 1) * entry(i, 2), 2);
        check_near(N_VWrmsNorm(f.x[1], f.x[2]), sqrt(squares / n), 1e-13, 0);
        destroy(&f);
    }
}

// Even and odd numbers of summands; the result may be the first of them.
TEST(linear_combinations_are_sums) {
    double c[COUNT] = {1.5, -0.5, 2, 3, -4};
    fixture f;
    for_each_length(f, n) {
        for (int count = 1; count <= COUNT; count++) {
            N_Vector result = count == COUNT ? f.x[0] : f.z;
            assert_int_equal(N_VLinearCombination(count, c, f.x, result), 0);
            for (int i = 0; i < n; i++) {
                double sum = 0;
                for (int k = 0; k < count; k++) sum += c[k] * entry(i, k);
                check_near(at(result, i), sum, 1e-14, 1e-14);
            }
        }
        destroy(&f);
    }
}
