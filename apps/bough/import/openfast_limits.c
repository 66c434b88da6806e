// Limits of the decks' numbers.
#include "apps/bough/import/openfast.h"

#include <string.h>

// What a number may be, in its line's unit. A value beyond would be refused later, in the scene, where nobody
// has written it.
typedef struct limit {
    const char *names;
    double low, high;
} limit;

static const limit elasto[] = {
    {"RotSpeed", -1e4, 1e4},
    {"NacYaw", -360, 360},
    {"TipRad", 0.01, 1e3},
    {"HubRad", 1e-3, 1e3},
    {"HubCM", -1e3, 1e3},
    {"UndSling", -1e3, 1e3},
    {"OverHang", -1e3, 1e3},
    {"ShftTilt", -360, 360},
    {"NacCMxn", -1e3, 1e3},
    {"NacCMyn", -1e3, 1e3},
    {"NacCMzn", -1e3, 1e3},
    {"Twr2Shft", -1e3, 1e3},
    {"TowerHt", -1e3, 1e4},
    {"TowerBsHt", -1e3, 1e4},
    {"TipMass(1)|TipMass1", 0, 1e9},
    {"TipMass(2)|TipMass2", 0, 1e9},
    {"TipMass(3)|TipMass3", 0, 1e9},
    {"HubMass", 0, 1e9},
    {"HubIner", 0, 1e15},
    {"GenIner", 0, 1e9},
    {"NacMass", 0, 1e9},
    {"NacYIner", 0, 1e15},
    {"YawBrMass", 0, 1e9},
    {"TeetDmp", 0, 1e20},
    {"TeetHSSp", 0, 1e20},
    {"GBRatio", 1e-3, 1e4},
    {"DTTorSpr", 0, 1e20},
    {"DTTorDmp", 0, 1e20},
};
static const limit servo[] = {
    {"GenEff", 0, 100},
    {"YawSpr", 0, 1e20},
    {"YawDamp", 0, 1e20},
};
static const limit inflow[] = {
    {"VFlowAng", -80, 80},
    {"HWindSpeed", 0, 200},
};
static const limit blade[] = {
    {"BldFlDmp(1)|BldFlDmp1", 0, 100},
    {"BldEdDmp(1)|BldEdDmp1", 0, 100},
    {"AdjBlMs", 1e-6, 1e6},
    {"AdjFlSt", 1e-6, 1e6},
    {"AdjEdSt", 1e-6, 1e6},
};
static const limit tower[] = {
    {"TwrFADmp(1)|TwrFADmp1", 0, 100},
    {"TwrSSDmp(1)|TwrSSDmp1", 0, 100},
    {"AdjTwMa", 1e-6, 1e6},
    {"AdjFASt", 1e-6, 1e6},
    {"AdjSSSt", 1e-6, 1e6},
};

#define LIMITS(list)                                                                                         \
    { sizeof(list) / sizeof *(list), list }
static const struct {
    int n;
    const limit *list;
} limits[] = {
    [BOUGH_LIMITS_ELASTO] = LIMITS(elasto), [BOUGH_LIMITS_SERVO] = LIMITS(servo),
    [BOUGH_LIMITS_INFLOW] = LIMITS(inflow), [BOUGH_LIMITS_BLADE] = LIMITS(blade),
    [BOUGH_LIMITS_TOWER] = LIMITS(tower),
};

void bough_openfast_check(const bough_deck *deck, bough_openfast_limits which) {
    for (int k = 0; k < limits[which].n && deck; k++) {
        const limit *x = &limits[which].list[k];
        double value = bough_deck_number_or(deck, x->names, x->low);
        if (value >= x->low && value <= x->high) continue;
        bough_deck_refuse(deck, x->names, "expected %g to %g, got %g", x->low, x->high, value);
    }
}
