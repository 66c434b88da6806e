// Numbers and units. A number is decimal in the strict form of JSON (no hexadecimal, no leading
// zero, no inf or nan), read in the C locale. A unit is a product of named units with SI
// prefixes and whole exponents: "MN m", "kg/m^3", "rad/s".
#include "apps/bough/config/schema.h"

enum { N_BASE = BOUGH_BASE_UNITS };

typedef struct unit {
    const char *symbol;
    double factor; // in SI
    int exponent[N_BASE];
    bool prefix; // takes SI prefixes
} unit;

static const unit units[] = {
    {"m", 1, {1, 0, 0, 0}, true},
    {"g", 1e-3, {0, 1, 0, 0}, true},
    {"t", 1e3, {0, 1, 0, 0}, false},
    {"s", 1, {0, 0, 1, 0}, true},
    {"min", 60, {0, 0, 1, 0}, false},
    {"h", 3600, {0, 0, 1, 0}, false},
    {"rad", 1, {0, 0, 0, 1}, true},
    {"deg", BOUGH_DEGREE, {0, 0, 0, 1}, false},
    {"rpm", BOUGH_RPM, {0, 0, -1, 1}, false},
    {"Hz", 1, {0, 0, -1, 0}, true},
    {"N", 1, {1, 1, -2, 0}, true},
    {"Pa", 1, {-1, 1, -2, 0}, true},
    {"W", 1, {2, 1, -3, 0}, true},
    {"1", 1, {0, 0, 0, 0}, false},
};

static const struct {
    const char *symbol;
    double factor;
} prefixes[] = {{"", 1},     {"n", 1e-9}, {"u", 1e-6}, {"µ", 1e-6}, {"m", 1e-3},
                {"c", 1e-2}, {"k", 1e3},  {"M", 1e6},  {"G", 1e9}};

static const struct {
    const char *name; // "expected …"
    const char *si, *example;
    int exponent[N_BASE];
} dimensions[] = {
    [BOUGH_PURE_NUMBER] = {"a number", "", "", {0, 0, 0, 0}},
    [BOUGH_TIME] = {"a time", "s", "20 ms", {0, 0, 1, 0}},
    [BOUGH_LENGTH] = {"a length", "m", "61.5 m", {1, 0, 0, 0}},
    [BOUGH_ANGLE] = {"an angle", "rad", "5 deg", {0, 0, 0, 1}},
    [BOUGH_ANGULAR_SPEED] = {"an angular speed", "rad/s", "12.1 rpm", {0, 0, -1, 1}},
    [BOUGH_SPEED] = {"a speed", "m/s", "20 m/s", {1, 0, -1, 0}},
    [BOUGH_ACCELERATION] = {"an acceleration", "m/s^2", "9.81 m/s^2", {1, 0, -2, 0}},
    [BOUGH_FREQUENCY] = {"a frequency", "Hz", "50 Hz", {0, 0, -1, 0}},
    [BOUGH_MASS] = {"a mass", "kg", "240 t", {0, 1, 0, 0}},
    [BOUGH_INERTIA] = {"a moment of inertia", "kg m^2", "1200 kg m^2", {2, 1, 0, 0}},
    [BOUGH_DENSITY] = {"a density", "kg/m^3", "1.225 kg/m^3", {-3, 1, 0, 0}},
    [BOUGH_FORCE] = {"a force", "N", "12 kN", {1, 1, -2, 0}},
    [BOUGH_MOMENT] = {"a moment", "N m", "11.9 MN m", {2, 1, -2, 0}},
    [BOUGH_STIFFNESS] = {"a stiffness", "N/m", "3 kN/m", {0, 1, -2, 0}},
    [BOUGH_LINE_FORCE] = {"a force per length", "N/m", "2 kN/m", {0, 1, -2, 0}},
    [BOUGH_LINE_MOMENT] = {"a moment per length", "N m/m", "5 kN m/m", {1, 1, -2, 0}},
    [BOUGH_POWER] = {"a power", "W", "5 MW", {2, 1, -3, 0}},
};

const char *bough_dimension_unit(bough_dimension dimension) { return dimensions[dimension].si; }

void bough_dimension_expected(bough_dimension dimension, char text[96]) {
    const char *name = dimensions[dimension].name, *si = dimensions[dimension].si;
    const char *example = dimensions[dimension].example;
    if (dimension == BOUGH_PURE_NUMBER) {
        snprintf(text, 96, "%s", name);
    } else if (dimension == BOUGH_ANGLE || dimension == BOUGH_ANGULAR_SPEED) {
        snprintf(text, 96, "%s with its unit, as '%s'", name, example);
    } else {
        snprintf(text, 96, "%s (in %s, or with a unit, as '%s')", name, si, example);
    }
}

void bough_schema_help_units(FILE *stream) {
    for (size_t i = 1; i < sizeof dimensions / sizeof dimensions[0]; i++) {
        fprintf(stream, "- %s in %s: '%s'\n", dimensions[i].name, dimensions[i].si, dimensions[i].example);
    }
}

// -- units ----------------------------------------------------------------------------------------

// A unit by its symbol without exponent: factor and exponents, NULL when there is none.
static const unit *find_unit(const char *symbol, double *factor) {
    for (size_t p = 0; p < sizeof prefixes / sizeof prefixes[0]; p++) {
        size_t length = strlen(prefixes[p].symbol);
        if (strncmp(symbol, prefixes[p].symbol, length) != 0) continue;
        for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
            *factor = prefixes[p].factor * units[i].factor;
            bool fits = length == 0 || units[i].prefix;
            if (fits && strcmp(units[i].symbol, symbol + length) == 0) return &units[i];
        }
    }
    return NULL;
}

// Cuts an exponent "^3", "3", "²", "³" off the end of a token.
static int cut_exponent(char *token) {
    static const char *const raised[] = {"²", "³"};
    size_t length = strlen(token);
    for (int i = 0; i < 2; i++) {
        if (length < 3 || strcmp(token + length - 2, raised[i]) != 0) continue;
        token[length - 2] = '\0';
        return i + 2;
    }
    if (length < 2 || token[length - 1] < '2' || token[length - 1] > '9') return 1;
    int exponent = token[length - 1] - '0';
    token[length - 1] = '\0';
    if (length >= 3 && token[length - 2] == '^') token[length - 2] = '\0';
    return exponent;
}

// Multiplies the product (factor, exponents) by token^sign.
static bool apply_token(char *token, int sign, double *factor, int exponent[N_BASE]) {
    int power = sign * cut_exponent(token);
    double size;
    const unit *u = find_unit(token, &size);
    if (u == NULL) return false;
    *factor *= pow(size, power);
    for (int k = 0; k < N_BASE; k++) exponent[k] += power * u->exponent[k];
    return true;
}

bool bough_unit_base(const char *text, double *factor, int exponent[BOUGH_BASE_UNITS], char why[160]) {
    int sign = 1;
    memset(exponent, 0, N_BASE * sizeof *exponent);
    *factor = 1;
    snprintf(why, 160, "the unit '%.40s' does not fit", text + strspn(text, " "));
    for (const char *c = text + strspn(text, " *"); *c != '\0'; c += strspn(c, " *")) {
        if (*c == '/') {
            if (sign < 0) break;
            sign = -1;
            c++;
            continue;
        }
        char token[24];
        size_t length = strcspn(c, " */");
        snprintf(token, sizeof token, "%.*s", (int)(length < 23 ? length : 23), c);
        if (!apply_token(token, sign, factor, exponent)) {
            snprintf(why, 160, "unknown unit '%s'", token);
            return false;
        }
        sign = 1;
        c += length;
    }
    return sign > 0;
}

bool bough_unit_fits(const char *text, bough_dimension dimension, double *factor, char why[160]) {
    int exponent[N_BASE];
    return bough_unit_base(text, factor, exponent, why) &&
           memcmp(exponent, dimensions[dimension].exponent, sizeof exponent) == 0;
}

// -- numbers --------------------------------------------------------------------------------------

static size_t digits(const char *text) { return strspn(text, "0123456789"); }

// Length of the number that the text starts with; 0: it starts with none.
static size_t number_length(const char *text) {
    const char *c = text;
    if (*c == '-' || *c == '+') c++;
    size_t whole = digits(c);
    if (whole > 1 && c[0] == '0') return 0;
    c += whole;
    size_t fraction = 0;
    if (*c == '.') {
        fraction = digits(c + 1);
        c += 1 + fraction;
    }
    if (whole + fraction == 0) return 0;
    if (*c == 'e' || *c == 'E') {
        const char *e = c + 1 + (c[1] == '-' || c[1] == '+');
        if (digits(e) > 0) c = e + digits(e);
    }
    return (size_t)(c - text);
}

locale_t bough_c_locale(void) { return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); }

// An angle without a unit may be meant in radians or in degrees; 0 is the same in both.
static bool is_ambiguous(const char *number, bough_dimension dimension, double value, char why[160]) {
    bool angle = dimension == BOUGH_ANGLE, speed = dimension == BOUGH_ANGULAR_SPEED;
    if (value == 0 || !(angle || speed)) return false;
    const char *si = angle ? "rad" : "rad/s", *usual = angle ? "deg" : "rpm";
    snprintf(why, 160, "%.30s %s is %.4g %s; write '%.30s %s' or '%.30s %s'", number, si,
             value * (angle ? 180 : 30) / BOUGH_PI, usual, number, usual, number, si);
    return true;
}

bool bough_quantity(const char *text, bough_dimension dimension, double *value, char why[160]) {
    size_t length = number_length(text);
    why[0] = '\0';
    if (length == 0) return false;
    *value = strtod(text, NULL);
    if (!isfinite(*value)) {
        snprintf(why, 160, "out of the range of numbers");
        return false;
    }
    const char *rest = text + length;
    if (*rest == '\0') return !is_ambiguous(text, dimension, *value, why);
    if (*rest != ' ' && strspn(rest, "0123456789.+-*/") > 0) return false;
    double factor;
    if (!bough_unit_fits(rest, dimension, &factor, why)) return false;
    *value *= factor;
    return isfinite(*value);
}

bool bough_whole_number(const char *text, int *value) {
    const char *c = text + (*text == '-');
    size_t length = digits(c);
    if (length == 0 || length > 9 || c[length] != '\0' || (length > 1 && *c == '0')) return false;
    *value = (int)strtol(text, NULL, 10);
    return true;
}
