#include "aero/wind.h"

bough_wind_def bough_wind_def_default(void) { return (bough_wind_def){.reference_height = 90}; }

bough_vec3 bough_wind_at(const bough_wind_def *wind, bough_vec3 position, double t) {
    (void)t; // steady wind; time is part of the interface because every other kind needs it
    if (wind->shear_exponent == 0) return bough_v3(wind->speed, 0, 0);
    double height = position.z / wind->reference_height;
    if (height <= 0) return bough_v3(0, 0, 0);
    return bough_v3(wind->speed * pow(height, wind->shear_exponent), 0, 0);
}
