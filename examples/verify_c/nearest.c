/* Moeller and Trumbore's test in double precision, behind the C ABI that verify_c.rs loads. */
#include <stddef.h>

static void sub(double r[3], const float a[3], const float b[3]) {
    for (int k = 0; k < 3; k++) r[k] = (double)a[k] - (double)b[k];
}

static void cross(double r[3], const double a[3], const double b[3]) {
    for (int k = 0; k < 3; k++) r[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Writes the nearest t with t_min < t < t_max and returns 1, or returns 0. Has no state: any thread may call it. */
int octray_nearest(const float (*corner)[3], size_t triangles, const float ray[8], float *t) {
    const double d[3] = {ray[3], ray[4], ray[5]};
    float nearest = ray[7];
    int found = 0;
    for (size_t i = 0; i < triangles; i++, corner += 3) {
        double e1[3], e2[3], s[3], p[3], q[3];
        sub(e1, corner[1], corner[0]);
        sub(e2, corner[2], corner[0]);
        sub(s, ray, corner[0]);
        cross(p, d, e2);
        cross(q, s, e1);
        const double scale = 1.0 / dot(e1, p), u = dot(s, p) * scale, v = dot(d, q) * scale;
        const float at = (float)(dot(e2, q) * scale);
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > ray[6] && at < nearest) {
            nearest = at;
            found = 1;
        }
    }
    if (found) *t = nearest;
    return found;
}
