// The solver of theory (79), compiled for several processors: induction_kernel.c.
#include "aero/rotor/induction.h"

bough_induction_options bough_induction_options_default(void) {
    return (bough_induction_options){BOUGH_HIGH_THRUST_SMOOTH, true, true, true, true, true, false};
}

int bough_induction_solve(const bough_induction_options *options, const bough_elements *elements,
                          double *axial, double *tangential, double *loss) {
    return BOUGH_OF_LEVEL(bough_induction_solve, bough_level_chosen())(options, elements, axial, tangential,
                                                                       loss);
}
