// Every vector operation against a naive loop, at lengths around the blocks and lanes.
#include "tests/unit/check.h"

#include "core/solve/vector.h"

#include <float.h>

static const int lengths[] = {1, 7, 8, 63, 64, 65, 200};
enum { N_LENGTHS = sizeof lengths / sizeof *lengths, MOST = 200, COUNT = 4 };

typedef struct fixture {
    SUNContext context;
    N_Vector x, y, w, z, several[COUNT], others[COUNT], results[COUNT];
} fixture;

// Of both signs and never zero; the sine's argument is exact, fused multiply-add or not.
static double entry(int i, int k) { return sin(1.75 * i + 0.875 * k) + 0.1 * k + 0.01; }

static N_Vector filled(N_Vector model, int k) {
    N_Vector v = N_VClone(model);
    for (int i = 0; i < N_VGetLength(v); i++) bough_vector_data(v)[i] = entry(i, k);
    return v;
}

static fixture create(int n) {
    fixture f;
    assert_int_equal(SUNContext_Create(NULL, &f.context), 0);
    f.z = bough_vector_create(n, f.context);
    assert_non_null(f.z);
    f.x = filled(f.z, 1);
    f.y = filled(f.z, 2);
    f.w = filled(f.z, 3);
    for (int k = 0; k < COUNT; k++) {
        f.several[k] = filled(f.z, 4 + k);
        f.others[k] = filled(f.z, 9 + k);
        f.results[k] = N_VClone(f.z);
    }
    return f;
}

static void destroy(fixture *f) {
    for (int k = 0; k < COUNT; k++) {
        N_VDestroy(f->several[k]);
        N_VDestroy(f->others[k]);
        N_VDestroy(f->results[k]);
    }
    N_VDestroy(f->x);
    N_VDestroy(f->y);
    N_VDestroy(f->w);
    N_VDestroy(f->z);
    SUNContext_Free(&f->context);
}

#define for_each_length(f, n)                                                                                \
    for (int which = 0, n; which < N_LENGTHS; which++)                                                       \
        if (n = lengths[which], f = create(n), 1)

static double at(N_Vector v, int i) { return bough_vector_data(v)[i]; }

TEST(data_is_aligned_and_cloned) {
    fixture f;
    for_each_length(f, n) {
        assert_int_equal((uintptr_t)bough_vector_data(f.x) % 64, 0);
        assert_ptr_equal(N_VGetArrayPointer(f.x), bough_vector_data(f.x));
        assert_int_equal(N_VGetLength(f.x), n);
        N_Vector empty = N_VCloneEmpty(f.x);
        double other[MOST];
        assert_null(bough_vector_data(empty));
        N_VSetArrayPointer(other, empty);
        N_VConst(4, empty);
        check_near(other[n - 1], 4, 0, 0);
        N_VDestroy(empty); // must not free the caller's data
        sunindextype reals, integers;
        N_VSpace(f.x, &reals, &integers);
        assert_int_equal(reals, n);
        destroy(&f);
    }
}

TEST(elementwise_operations) {
    fixture f;
    for_each_length(f, n) {
        N_VLinearSum(2, f.x, -3, f.y, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), 2 * entry(i, 1) - 3 * entry(i, 2), 1e-14, 1e-14);
        N_VProd(f.x, f.y, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), entry(i, 1) * entry(i, 2), 1e-15, 0);
        N_VDiv(f.x, f.y, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), entry(i, 1) / entry(i, 2), 1e-15, 0);
        N_VScale(-1.5, f.x, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), -1.5 * entry(i, 1), 1e-15, 0);
        N_VAbs(f.x, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), fabs(entry(i, 1)), 0, 0);
        N_VInv(f.x, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), 1 / entry(i, 1), 1e-15, 0);
        N_VAddConst(f.x, 0.25, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), entry(i, 1) + 0.25, 1e-15, 0);
        N_VCompare(0.5, f.x, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), fabs(entry(i, 1)) >= 0.5, 0, 0);
        N_VConst(7, f.z);
        for (int i = 0; i < n; i++) check_near(at(f.z, i), 7, 0, 0);
        destroy(&f);
    }
}

TEST(reductions) {
    fixture f;
    for_each_length(f, n) {
        double dot = 0, most = 0, low = DBL_MAX, l1 = 0, squares = 0, masked = 0, ratio = DBL_MAX;
        bough_vector_data(f.y)[n / 2] = 0; // a denominator to be left out
        for (int i = 0; i < n; i++) {
            double x = at(f.x, i), y = at(f.y, i), w = at(f.w, i);
            dot += x * y;
            most = fmax(most, fabs(x));
            low = fmin(low, x);
            l1 += fabs(x);
            squares += x * w * x * w;
            if (y > 0) masked += x * w * x * w;
            if (y != 0) ratio = fmin(ratio, x / y);
        }
        check_near(N_VDotProd(f.x, f.y), dot, 1e-13, 1e-13);
        check_near(N_VMaxNorm(f.x), most, 0, 0);
        check_near(N_VMin(f.x), low, 0, 0);
        check_near(N_VL1Norm(f.x), l1, 1e-13, 0);
        check_near(N_VWL2Norm(f.x, f.w), sqrt(squares), 1e-13, 0);
        check_near(N_VWrmsNorm(f.x, f.w), sqrt(squares / n), 1e-13, 0);
        check_near(N_VWrmsNormMask(f.x, f.w, f.y), sqrt(masked / n), 1e-13, 0);
        check_near(N_VMinQuotient(f.x, f.y), ratio, 0, 0);
        destroy(&f);
    }
}

TEST(tests_with_a_verdict) {
    fixture f;
    for_each_length(f, n) {
        assert_true(N_VInvTest(f.x, f.z));
        check_near(at(f.z, n - 1), 1 / at(f.x, n - 1), 1e-15, 0);
        bough_vector_data(f.x)[n / 2] = 0;
        N_VConst(5, f.z);
        assert_false(N_VInvTest(f.x, f.z));
        check_near(at(f.z, n / 2), 5, 0, 0);
        // constraints in turn: free, >= 0, > 0, <= 0, < 0; x in turn 0, 1, −1
        const double kind[5] = {0, 1, 2, -1, -2}, value[3] = {0, 1, -1};
        int broken = 0;
        for (int i = 0; i < n; i++) {
            bough_vector_data(f.w)[i] = kind[i % 5];
            bough_vector_data(f.x)[i] = value[i % 3];
        }
        int verdict = N_VConstrMask(f.w, f.x, f.z);
        for (int i = 0; i < n; i++) {
            double c = kind[i % 5], x = value[i % 3];
            int bad = (c == 1 && x < 0) || (c == 2 && x <= 0) || (c == -1 && x > 0) || (c == -2 && x >= 0);
            check_near(at(f.z, i), bad, 0, 0);
            broken += bad;
        }
        assert_int_equal(verdict, broken == 0);
        destroy(&f);
    }
}

TEST(fused_operations) {
    fixture f;
    double c[COUNT] = {1, -0.5, 2, 3}, dots[COUNT], norms[COUNT];
    for_each_length(f, n) {
        assert_int_equal(N_VScaleAddMulti(COUNT, c, f.x, f.several, f.results), 0);
        assert_int_equal(N_VDotProdMulti(COUNT, f.x, f.several, dots), 0);
        for (int k = 0; k < COUNT; k++) {
            double dot = 0;
            for (int i = 0; i < n; i++) {
                dot += entry(i, 1) * entry(i, 4 + k);
                check_near(at(f.results[k], i), c[k] * entry(i, 1) + entry(i, 4 + k), 1e-14, 1e-14);
            }
            check_near(dots[k], dot, 1e-13, 1e-13);
        }
        assert_int_equal(N_VLinearSumVectorArray(COUNT, 2, f.several, -1, f.others, f.results), 0);
        for (int k = 0; k < COUNT; k++) {
            check_near(at(f.results[k], n - 1), 2 * entry(n - 1, 4 + k) - entry(n - 1, 9 + k), 1e-14, 1e-14);
        }
        assert_int_equal(N_VWrmsNormVectorArray(COUNT, f.several, f.others, norms), 0);
        for (int k = 0; k < COUNT; k++) {
            check_near(norms[k], N_VWrmsNorm(f.several[k], f.others[k]), 0, 0);
        }
        assert_int_equal(N_VScaleVectorArray(COUNT, c, f.several, f.results), 0);
        for (int k = 0; k < COUNT; k++) {
            check_near(at(f.results[k], 0), c[k] * entry(0, 4 + k), 1e-15, 0);
        }
        assert_int_equal(N_VConstVectorArray(COUNT, 3, f.results), 0);
        for (int k = 0; k < COUNT; k++) check_near(at(f.results[k], n - 1), 3, 0, 0);
        // even and odd numbers of summands; the result may be the first of them
        for (int count = COUNT; count >= 1; count--) {
            N_Vector result = count == 3 ? f.several[0] : f.z;
            N_VScale(1, f.several[0], f.x);
            assert_int_equal(N_VLinearCombination(count, c, f.several, result), 0);
            for (int i = 0; i < n; i++) {
                double sum = c[0] * at(f.x, i);
                for (int k = 1; k < count; k++) sum += c[k] * entry(i, 4 + k);
                check_near(at(result, i), sum, 1e-14, 1e-14);
            }
        }
        destroy(&f);
    }
}
