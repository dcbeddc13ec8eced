/* Contact of a chain of rigid segments with polyline walls: forces, tangent blocks, candidate pairs.
 *
 * Plain C99 without the C library (the sines and cosines come from the caller), so that one small shared
 * object a platform serves every interpreter. Units: SI. Frame: the plane of the scenario, turned so that the
 * catheter points along +x. Body i carries (x, y, angle) of its centre; e = (cos, sin) points to the tip,
 * n = (-sin, cos) to its left. Node i is the distal end of body i; a wall's lumen lies on its left.
 *
 * Two kinds of pair, each counted once:
 *   node disc   against wall segment: fades towards wall ends that point into the lumen, where the corner takes over;
 *   wall corner against wire segment: shared between neighbours by weights that sum to one about the joint's bisector,
 *                                     with the round disc beyond a joint and at the tip.
 * Normal force: penalty with a quadratic toe and a damper that grows with penetration, never pulling [Sharei et al.
 * 2019, Eqs. 4-5; damper as in Hunt and Crossley 1975]. Tangential force: Coulomb with an elastic tangential spring and
 * return mapping, so that a stuck contact does not creep at all [in place of Eq. 6].
 * The tangent leaves out only how the rate changes with place, which is below a thousandth of the stiffness.
 * Both act on the wire's axis (thin wire: no moment r*f), and slip is that of the axis, so friction cannot add energy.
 */

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef struct {
    int bodies, walls, corners;
    double radius, stiffness, damping, toe, tangential_stiffness;
    const double *half_length;                                 /* (bodies) */
    const double *joint_blend;                                 /* (bodies): half width of the hand-over at the distal joint */
    const double *wall_x, *wall_y, *wall_tx, *wall_ty;         /* (walls): start and unit tangent */
    const double *wall_length, *wall_lo, *wall_hi;             /* (walls): length, where the weight has fallen to zero */
    const double *wall_fade_lo, *wall_fade_hi;                 /* (walls): width over which it falls */
    const double *wall_friction;                               /* (walls) */
    const double *wire_friction;                               /* (bodies + 1): factor at the nodes, the proximal end first */
    const int *wall_sharp;                                     /* (walls): bit 0: start points into the lumen, bit 1: end does */
    const int *wall_tube;                                      /* (walls): 1 catheter, 0 vessel */
    const double *corner_x, *corner_y, *corner_friction;       /* (corners) */
    const int *corner_tube;                                    /* (corners) */
    double *wall_boxes, *corner_boxes, *body_boxes;            /* as gw_contact_boxes counts them; see Boxes */
    double reach;                                              /* m, of travel, within which pairs were sought */
    double *seen;                                              /* (3 bodies): the place for which `near` of the pairs holds */
} System;

/* Per pair, in and out. Node pairs: target = wall. Corner pairs: target = corner. */
typedef struct {
    int capacity, count;
    int *body, *target;
    double *side;                                              /* corner pairs: +1 left, -1 right, 0 not passed yet */
    double *start;                                             /* elastic slip at the start of the step, m */
    double *held;                                              /* share of the full stiffness at the start of the step, 0 to 1 */
    double *gap, *normal, *tangential, *weight, *energy;       /* results: m, N, N, -, J */
    double *slip, *elastic;                                    /* results, m: slip since the start of the step; elastic slip now */
    double *normal_stiffness, *tangential_stiffness;           /* results: N/m, weighted, without damping */
    double *line, *slope;                                      /* results: the normal spring's tangent, line (m) + slope * (toe - gap); slope 0: open */
    double *was_line, *was_slope;                              /* the same at the place from which Newton stepped */
    int near_count, *near;                                     /* pairs that can touch near `seen`; none known: -1 */
} Pairs;

/* Motion of the bodies. c, s: cosine and sine of the angle. c0, s0 and x0, y0: at the start of the step. */
typedef struct {
    const double *q, *c, *s, *v, *q0, *c0, *s0;
    int predicted;                                             /* 1: a step's first guess; its tangent keeps the held stiffness */
    int followed;                                              /* 1: a place to which Newton stepped from that of was_line, was_slope */
} Motion;

/* Bounding boxes of runs of 8, of 64 and of 512 neighbours in a list: walls, corners and segments come in the order of their
 * lines, so runs lie together. A search leaves out runs that are too far; what it finds comes in the list's order, as if
 * it had looked at all. Four numbers a box: least x, least y, largest x, largest y. */
enum { RUN = 8, LEVELS = 3 };
typedef struct { int count; double *box; } Boxes;

static double square_root(double x) { return __builtin_sqrt(x); }
static double magnitude(double x) { return x < 0 ? -x : x; }
static double clamp(double x, double lo, double hi) { return x < lo ? lo : (x > hi ? hi : x); }

/* Smooth step from 0 at x <= 0 to 1 at x >= 1, and its derivative. */
static double smooth(double x) { x = clamp(x, 0, 1); return x * x * (3 - 2 * x); }
static double smooth_slope(double x) { x = clamp(x, 0, 1); return 6 * x * (1 - x); }

typedef struct {
    double normal, tangential;      /* N; tangential: on the wire, along increasing slip (so it opposes slip) */
    double d_gap, d_rate;           /* d normal / d gap, d normal / d rate */
    double stiffness;               /* N/m, of the normal spring here, without damper and held share */
    double d_slip, d_normal;        /* d tangential / d slip, d tangential / d normal */
    double d_friction;              /* N, d tangential / d friction coefficient */
    double elastic;                 /* m, the slip that the tangential spring keeps */
    double energy;                  /* J, in the normal and the tangential spring */
    double line, slope;             /* as in Pairs */
} Law;

/* Depth of the normal spring, in which its force is linear, and its slope, where a contact is `in` past its onset. */
static double depth_at(double toe, double in) { return in <= 0 ? 0 : in < 2 * toe ? in * in / (4 * toe) : in - toe; }
static double slope_at(double toe, double in) { return in <= 0 ? 0 : in < 2 * toe ? in / (2 * toe) : 1; }

/* Where the normal spring is taken by its tangent, for a contact that is `in` past its onset.
 *
 * Plain Newton takes it at `in`. Where walls only just touch, the quadratic onset then has a double root, and each iteration no
 * more than halves what is left. What the wire can do is to set the force, not the place: so it is taken where the spring has
 * the force that the linear step foresaw, which is never deeper, as the spring stiffens. The force given is that of the
 * tangent at `in`. It is off by the share (in - at) / (2 at) of what then is off balance there: by LEAST, twice that at
 * most, so a step that is balanced to the tolerance has the forces of the law. */
static const double LEAST = 0.2;

static double taken_at(double toe, double in, double was_line, double was_slope)
{
    if (in <= 0 || was_slope <= 0) return in;
    const double foreseen = was_line + was_slope * in;
    const double at = foreseen <= 0 ? 0 : foreseen < toe ? 2 * square_root(toe * foreseen) : foreseen + toe;
    return clamp(at, LEAST * in, in);
}

/* `held`: least share of the stiffness that the tangent keeps. The first guess of a step may lift a wire off the walls that
 * carry it; without their stiffness a compressed wire has next to none, and Newton's first step goes far astray. */
static Law contact_law(const System *sys, double gap, double rate, double elastic_slip, double friction, double held,
                       double was_line, double was_slope)
{
    Law law;
    const double toe = sys->toe, in = toe - gap, at = taken_at(toe, in, was_line, was_slope);
    const double slope = slope_at(toe, at), depth = depth_at(toe, at) + slope * (in - at);
    const double u = clamp(in, 0, 2 * toe), deep = gap < -toe ? -gap - toe : 0;
    const double modulus = sys->stiffness - sys->damping * rate;
    const int pushing = modulus > 0;
    law.normal = pushing ? depth * modulus : 0;
    law.slope = pushing ? (slope > held ? slope : held) : 0;
    law.line = depth - law.slope * in;
    law.d_gap = pushing ? -law.slope * modulus : 0;
    law.d_rate = pushing ? -depth * sys->damping : 0;
    law.stiffness = pushing ? slope * sys->stiffness : 0;
    law.energy = sys->stiffness * (u * u * u / (12 * toe) + deep * (toe + 0.5 * deep));

    /* A spring that softens from 0.9 of the limit on and is at the limit at 1.1: force and stiffness are continuous. */
    const double soft = 0.1;
    const double limit = friction * law.normal, modulus_t = sys->tangential_stiffness;
    law.tangential = law.d_slip = law.d_normal = law.d_friction = law.elastic = 0;
    if (limit > 0) {
        const double sign = elastic_slip < 0 ? -1 : 1, ratio = magnitude(elastic_slip) * modulus_t / limit;
        const double kept = ratio < 1 + soft ? ratio : 1 + soft, over = kept > 1 - soft ? kept - (1 - soft) : 0;
        const double share = kept - over * over / (4 * soft), slope_t = ratio < 1 + soft ? 1 - over / (2 * soft) : 0;
        law.elastic = sign * kept * limit / modulus_t;
        law.tangential = -sign * limit * share;
        law.d_slip = -modulus_t * slope_t;
        law.d_normal = -sign * friction * (share - ratio * slope_t);
        law.d_friction = -sign * law.normal * (share - ratio * slope_t);
        law.energy += limit * limit / modulus_t * (0.5 * kept * kept - over * over * over / (12 * soft));
    }
    return law;
}

static void store(Pairs *p, int i, double gap, const Law *law, double weight, double slip)
{
    p->gap[i] = gap; p->normal[i] = law->normal; p->tangential[i] = law->tangential;
    p->weight[i] = weight; p->energy[i] = weight * law->energy;
    p->slip[i] = slip; p->elastic[i] = law->elastic;
    p->line[i] = law->line; p->slope[i] = law->slope;
    p->normal_stiffness[i] = weight * law->stiffness; p->tangential_stiffness[i] = -weight * law->d_slip;
}

/* A pair that does not touch; nothing but its gap matters. What touches has a weight. */
static void store_open(Pairs *p, int i, double gap)
{
    p->gap[i] = gap;
    p->line[i] = p->slope[i] = 0;
    if (p->weight[i] == 0) return;
    p->normal[i] = p->tangential[i] = p->weight[i] = p->energy[i] = p->slip[i] = p->elastic[i] = 0;
    p->normal_stiffness[i] = p->tangential_stiffness[i] = 0;
}

/* Beside a corner that points into the lumen, a node whose centre is behind the wall by more than a quarter of its distance
 * from the corner has gone round it, on the corner's other side: this wall does not hold it. */
static const double PASSING = 4;

/* force (3) += , tangent (9) += derivative of the force: position part times fq, velocity part times fv. */
static void node_pair(const System *sys, const Motion *m, Pairs *p, int i, double fq, double fv, double *force, double *tangent)
{
    const int b = p->body[i], w = p->target[i];
    const double *q = m->q + 3 * b, *v = m->v + 3 * b, *q0 = m->q0 + 3 * b, h = sys->half_length[b];
    const double ax = h * m->c[b], ay = h * m->s[b];                            /* arm from the centre to the node */
    const double tx = sys->wall_tx[w], ty = sys->wall_ty[w], nx = -ty, ny = tx;
    const double rx = q[0] + ax - sys->wall_x[w], ry = q[1] + ay - sys->wall_y[w];
    const double gap = nx * rx + ny * ry - sys->radius, along = tx * rx + ty * ry;
    const double held = m->predicted ? p->held[i] : 0;
    if (gap >= sys->toe && held == 0) { store_open(p, i, gap); return; }
    const double mx = q[0] + ax - q0[0] - h * m->c0[b], my = q[1] + ay - q0[1] - h * m->s0[b];
    const double slip = tx * mx + ty * my;
    const double height = gap + sys->radius, behind = height < 0 ? PASSING : 0, at_lo = sys->wall_sharp[w] & 1 ? behind : 0, at_hi = sys->wall_sharp[w] & 2 ? behind : 0;
    const double a = (along - sys->wall_lo[w] + at_lo * height) / sys->wall_fade_lo[w];
    const double z = (sys->wall_hi[w] - along + at_hi * height) / sys->wall_fade_hi[w];
    const double weight = smooth(a) * smooth(z);
    if (weight <= 0) { store_open(p, i, gap); return; }
    const double rate = nx * (v[0] - ay * v[2]) + ny * (v[1] + ax * v[2]);
    const Law law = contact_law(sys, gap, rate, p->start[i] + slip, sys->wall_friction[w] * sys->wire_friction[b + 1], held,
                                p->was_line[i], m->followed ? p->was_slope[i] : 0);
    store(p, i, gap, &law, weight, slip);

    const double G[3] = {nx, ny, -nx * ay + ny * ax}, T[3] = {tx, ty, -tx * ay + ty * ax};   /* of gap and of slip */
    const double from_lo = smooth_slope(a) / sys->wall_fade_lo[w] * smooth(z), from_hi = smooth(a) * smooth_slope(z) / sys->wall_fade_hi[w];
    const double d_normal = law.d_gap * fq + law.d_rate * fv;
    double F[3];
    for (int r = 0; r < 3; r++) {
        F[r] = law.normal * G[r] + law.tangential * T[r];
        force[r] += weight * F[r];
        for (int c = 0; c < 3; c++)
            tangent[3 * r + c] += weight * (d_normal * G[c] * (G[r] + law.d_normal * T[r]) + law.d_slip * fq * T[r] * T[c])
                                + fq * F[r] * ((from_lo - from_hi) * T[c] + (from_lo * at_lo + from_hi * at_hi) * G[c]);
    }
    tangent[8] -= weight * fq * (law.normal * (nx * ax + ny * ay) + law.tangential * (tx * ax + ty * ay));
}

/* Place of a corner in the frame of a body, and what the pair needs of it. */
typedef struct {
    double x, y;                    /* along e and n, from the body's centre */
    double over;                    /* how far past the segment's end (0 beside it) */
    double foot;                    /* of the nearest point of the axis, along e */
    double ux, uy;                  /* direction in which the gap grows with the corner's place */
    double tx, ty;                  /* direction in which the wire slides past the corner, towards the tip */
    double turn;                    /* +1 or -1: the sense in which (tx, ty) turns with (ux, uy) */
    double distance, curvature;     /* from the axis, signed; 1/distance where the corner faces a round end */
} Place;

static Place corner_place(const System *sys, const Motion *m, int b, double cx, double cy, double side)
{
    Place pl;
    const double dx = cx - m->q[3 * b], dy = cy - m->q[3 * b + 1], h = sys->half_length[b];
    pl.x = dx * m->c[b] + dy * m->s[b];
    pl.y = -dx * m->s[b] + dy * m->c[b];
    pl.foot = clamp(pl.x, -h, h);
    pl.over = pl.x - pl.foot;
    pl.turn = side < 0 ? -1 : 1;        /* not passed yet: one sense, whichever way the tip leans, so that kept slip keeps its sign */
    if (side == 0) side = pl.y < 0 ? -1 : 1;
    const int ahead = b == sys->bodies - 1 && pl.over > 0;
    if (pl.over != 0 && (side * pl.y > 0 || ahead)) {
        pl.distance = square_root(pl.over * pl.over + pl.y * pl.y);
        pl.curvature = 1 / pl.distance;
        pl.ux = pl.over * pl.curvature;
        pl.uy = pl.y * pl.curvature;
    } else {
        pl.distance = side * pl.y;
        pl.curvature = 0;
        pl.ux = 0;
        pl.uy = side;
    }
    pl.tx = pl.turn * pl.uy;
    pl.ty = -pl.turn * pl.ux;
    return pl;
}

/* Weight of body b at its distal (end = +1) or proximal (-1) joint with body o; gradient in the body's frame. */
static double joint_weight(const Motion *m, int b, int o, double h, double blend, int end, const Place *pl, double *gradient)
{
    double ex = m->c[b] + m->c[o], ey = m->s[b] + m->s[o];
    const double norm = square_root(ex * ex + ey * ey) + 1e-300;
    ex /= norm; ey /= norm;
    const double ca = ex * m->c[b] + ey * m->s[b], sa = -ex * m->s[b] + ey * m->c[b];   /* bisector seen from the body */
    const double rx = pl->x - end * h, zeta = rx * ca + pl->y * sa;
    const double argument = 0.5 - end * zeta / (2 * blend), slope = -end * smooth_slope(argument) / (2 * blend);
    gradient[0] = -slope * ca;
    gradient[1] = -slope * sa;
    gradient[2] = slope * (-end * h * sa + 0.5 * (-rx * sa + pl->y * ca));
    return smooth(argument);
}

static void corner_pair(const System *sys, const Motion *m, Pairs *p, int i, double fq, double fv, double *force, double *tangent)
{
    const int b = p->body[i], k = p->target[i], last = sys->bodies - 1;
    const double *q = m->q + 3 * b, *v = m->v + 3 * b, *q0 = m->q0 + 3 * b, cb = m->c[b], sb = m->s[b];
    const Place pl = corner_place(sys, m, b, sys->corner_x[k], sys->corner_y[k], p->side[i]);
    const double gap = pl.distance - sys->radius, held = m->predicted ? p->held[i] : 0;
    if (gap >= sys->toe && held == 0) { store_open(p, i, gap); return; }
    /* Motion of the axis's nearest point since the step's start: a fixed point of the body where the corner faces a round end. */
    const double arm = pl.over != 0 ? pl.foot : 0;
    const double dx = q[0] - q0[0] + arm * (cb - m->c0[b]), dy = q[1] - q0[1] + arm * (sb - m->s0[b]);
    const double mx = dx * cb + dy * sb, my = -dx * sb + dy * cb, slip = mx * pl.tx + my * pl.ty;
    double far[3] = {0, 0, 0}, near[3] = {0, 0, 0}, w_far = 1, w_near = 1;
    if (b < last) w_far = joint_weight(m, b, b + 1, sys->half_length[b], sys->joint_blend[b], 1, &pl, far);
    if (b > 0) w_near = joint_weight(m, b, b - 1, sys->half_length[b], sys->joint_blend[b - 1], -1, &pl, near);
    const double weight = w_far * w_near;
    if (weight <= 0) { store_open(p, i, gap); return; }

    const double G[3] = {-pl.ux, -pl.uy, pl.ux * pl.y - pl.uy * pl.x};                 /* of the gap, in the body's frame */
    const double turn = -pl.uy * pl.y - pl.ux * pl.x, bends = pl.turn * pl.curvature;
    const double P[3] = {pl.uy, -pl.ux, turn};                                        /* of the place along the round end */
    const double T[3] = {pl.tx, pl.ty, arm * pl.ty}, N[3] = {pl.ux, pl.uy, arm * pl.uy};
    double U[3];                                                                      /* of the slip */
    for (int c = 0; c < 3; c++) U[c] = T[c] + bends * (mx * pl.ux + my * pl.uy) * P[c];
    U[2] += my * pl.tx - mx * pl.ty;
    const double rate = G[0] * (v[0] * cb + v[1] * sb) + G[1] * (-v[0] * sb + v[1] * cb) + G[2] * v[2];
    /* The wire's factor at the place that touches, and how the friction changes as the place moves along the segment. */
    const double h = sys->half_length[b], change = (sys->wire_friction[b + 1] - sys->wire_friction[b]) / (2 * h);
    const double friction = sys->corner_friction[k] * (sys->wire_friction[b] + change * (pl.foot + h));
    const double slope = pl.over == 0 ? sys->corner_friction[k] * change : 0, along[3] = {-slope, 0, slope * pl.y};
    const Law law = contact_law(sys, gap, rate, p->start[i] + slip, friction, held, p->was_line[i], m->followed ? p->was_slope[i] : 0);
    store(p, i, gap, &law, weight, slip);

    const double d_normal = law.d_gap * fq + law.d_rate * fv;
    double F[3], K[3][3];
    for (int r = 0; r < 3; r++) F[r] = law.normal * G[r] + law.tangential * T[r];
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++)
        K[r][c] = weight * (d_normal * G[c] * (G[r] + law.d_normal * T[r]) + law.d_slip * fq * T[r] * U[c])
                + weight * fq * law.d_friction * along[c] * T[r]
                + weight * fq * (law.normal * pl.curvature * P[r] + law.tangential * bends * N[r]) * P[c]
                + fq * F[r] * (far[c] * w_near + near[c] * w_far);
    const double wn = weight * law.normal * fq, wt = weight * law.tangential * fq;
    K[0][2] += wn * pl.uy - wt * pl.ty;
    K[1][2] += -wn * pl.ux + wt * pl.tx;
    K[2][0] += wn * pl.uy;
    K[2][1] += -wn * pl.ux;
    K[2][2] += wn * turn;

    force[0] += weight * (F[0] * cb - F[1] * sb);
    force[1] += weight * (F[0] * sb + F[1] * cb);
    force[2] += weight * F[2];
    double R[3][3];
    for (int c = 0; c < 3; c++) {
        R[0][c] = K[0][c] * cb - K[1][c] * sb;
        R[1][c] = K[0][c] * sb + K[1][c] * cb;
        R[2][c] = K[2][c];
    }
    for (int r = 0; r < 3; r++) {
        tangent[3 * r] += R[r][0] * cb - R[r][1] * sb;
        tangent[3 * r + 1] += R[r][0] * sb + R[r][1] * cb;
        tangent[3 * r + 2] += R[r][2];
    }
}

/* Of the thousands of pairs with a wall of many facets few can touch without a move of the wire. Those are looked at in every
 * evaluation, the others when a segment has moved by SLACK of the radius. No force depends on it. */
static const double SLACK = 1;

static int strayed(const System *sys, const Motion *m)
{
    const double slack = SLACK * sys->radius, around = 3 * (sys->radius + sys->toe + sys->reach);
    for (int b = 0; b < sys->bodies; b++) {
        const double *q = m->q + 3 * b, *seen = sys->seen + 3 * b;
        const double turned = magnitude(q[2] - seen[2]) * (sys->half_length[b] + around);   /* at the pairs' places */
        if (!(magnitude(q[0] - seen[0]) + magnitude(q[1] - seen[1]) + turned < slack)) return 1;
    }
    return 0;
}

static double node_gap(const System *sys, const Motion *m, int b, int w, double *along)
{
    const double h = sys->half_length[b], tx = sys->wall_tx[w], ty = sys->wall_ty[w];
    const double rx = m->q[3 * b] + h * m->c[b] - sys->wall_x[w], ry = m->q[3 * b + 1] + h * m->s[b] - sys->wall_y[w];
    *along = tx * rx + ty * ry;
    return -ty * rx + tx * ry - sys->radius;
}

static double corner_gap(const System *sys, const Motion *m, const Pairs *p, int i)
{
    const int k = p->target[i];
    return corner_place(sys, m, p->body[i], sys->corner_x[k], sys->corner_y[k], p->side[i]).distance - sys->radius;
}

static void look_around(const System *sys, const Motion *m, Pairs *nodes, Pairs *corners)
{
    const double slack = SLACK * sys->radius, open = sys->toe + slack;
    for (int i = 0; i < 3 * sys->bodies; i++) sys->seen[i] = m->q[i];
    nodes->near_count = corners->near_count = 0;
    for (int i = 0; i < nodes->count; i++) {
        const int w = nodes->target[i];
        double along;
        const double gap = node_gap(sys, m, nodes->body[i], w, &along);
        const int near = gap < open && along > sys->wall_lo[w] - slack && along < sys->wall_hi[w] + slack;
        if (near || nodes->held[i] != 0) nodes->near[nodes->near_count++] = i;
        else store_open(nodes, i, gap);
    }
    for (int i = 0; i < corners->count; i++) {
        const double gap = corner_gap(sys, m, corners, i);
        if (gap < open || corners->held[i] != 0) corners->near[corners->near_count++] = i;
        else store_open(corners, i, gap);
    }
}

static void step_on(Pairs *p)
{
    for (int i = 0; i < p->count; i++) {
        p->was_line[i] = p->line[i];
        p->was_slope[i] = p->slope[i];
    }
}

/* Newton steps on from the place of the last evaluation. */
EXPORT void gw_contact_step_on(Pairs *nodes, Pairs *corners)
{
    step_on(nodes);
    step_on(corners);
}

/* force (3 bodies), tangent (9 bodies, row by row of each block) are overwritten. */
EXPORT void gw_contact_evaluate(const System *sys, const Motion *m, Pairs *nodes, Pairs *corners,
                                double fq, double fv, double *force, double *tangent)
{
    for (int i = 0; i < 3 * sys->bodies; i++) force[i] = 0;
    for (int i = 0; i < 9 * sys->bodies; i++) tangent[i] = 0;
    if (nodes->near_count < 0 || corners->near_count < 0 || strayed(sys, m)) look_around(sys, m, nodes, corners);
    for (int j = 0; j < nodes->near_count; j++) {
        const int i = nodes->near[j], b = nodes->body[i];
        node_pair(sys, m, nodes, i, fq, fv, force + 3 * b, tangent + 9 * b);
    }
    for (int j = 0; j < corners->near_count; j++) {
        const int i = corners->near[j], b = corners->body[i];
        corner_pair(sys, m, corners, i, fq, fv, force + 3 * b, tangent + 9 * b);
    }
}

/* Add to the tangent how the joints' forces turn each segment as it turns. reaction (2 bodies): N, minus the force on the
 * proximal end. What makes the segment resist the turn less is left out where `stiffening` is set. */
EXPORT void gw_contact_turning(const System *sys, const Motion *m, const double *reaction, int stiffening, double *tangent)
{
    for (int b = 0; b < sys->bodies; b++) {
        double along = -(m->c[b] * reaction[2 * b] + m->s[b] * reaction[2 * b + 1]);
        if (b + 1 < sys->bodies) along -= m->c[b] * reaction[2 * b + 2] + m->s[b] * reaction[2 * b + 3];
        if (along < 0 || !stiffening) tangent[9 * b + 8] += sys->half_length[b] * along;
    }
}

/* Weight from which a pair is the one that counts where two share a contact. */
static const double COUNTS = 0.5;

/* Share of the way from the place `before` to that of the last evaluation where the first contact closes that was open there:
 * 0 to 1; 1 if none closes. */
EXPORT double gw_contact_share_to_touch(const System *sys, const Motion *before, const Pairs *nodes, const Pairs *corners)
{
    double share = 1, along;
    for (int list = 0; list < 2; list++) {
        const Pairs *p = list ? corners : nodes;
        for (int j = 0; j < p->near_count; j++) {
            const int i = p->near[j];
            if (p->gap[i] >= -sys->toe || p->weight[i] <= COUNTS) continue;
            const double gap = list ? corner_gap(sys, before, p, i) : node_gap(sys, before, p->body[i], p->target[i], &along);
            if (gap >= sys->toe && gap / (gap - p->gap[i]) < share) share = gap / (gap - p->gap[i]);
        }
    }
    return share;
}

/* What the last evaluation found, all pairs together. deepest: m, of `body` in wall (or corner) `target`, -1: none. largest: N,
 * of one contact with the vessel. energy, friction, damping: J, in the springs, and lost since the start of the step. */
typedef struct { double deepest, largest, energy, friction, damping; int body, target, corner; } Summary;

EXPORT void gw_contact_summary(const System *sys, const Motion *m, const Pairs *nodes, const Pairs *corners, Summary *found)
{
    const Motion start = {m->q0, m->c0, m->s0, m->v, m->q0, m->c0, m->s0, 0, 0};
    const Summary nothing = {0, 0, 0, 0, 0, -1, -1, 0};
    double along;
    *found = nothing;
    for (int list = 0; list < 2; list++) {
        const Pairs *p = list ? corners : nodes;
        for (int j = 0; j < p->near_count; j++) {
            const int i = p->near[j], k = p->target[i];
            const double weight = p->weight[i], normal = p->normal[i], tangential = p->tangential[i], gap = p->gap[i];
            if (weight <= 0) continue;
            if (weight > COUNTS && -gap > found->deepest) {
                found->deepest = -gap; found->body = p->body[i]; found->target = k; found->corner = list;
            }
            const double force = weight * square_root(normal * normal + tangential * tangential);
            if (!(list ? sys->corner_tube : sys->wall_tube)[k] && force > found->largest) found->largest = force;
            found->energy += p->energy[i];
            /* Sliding is the slip that the tangential spring did not take up; the force opposes it. */
            if (normal > 0) found->friction -= weight * tangential * (p->slip[i] - (p->elastic[i] - p->start[i]));
            const double u = clamp(sys->toe - gap, 0, 2 * sys->toe), deep = gap < -sys->toe ? -gap - sys->toe : 0;
            const double undamped = sys->stiffness * (u * u / (4 * sys->toe) + deep);
            const double gap0 = list ? corner_gap(sys, &start, p, i) : node_gap(sys, &start, p->body[i], k, &along);
            found->damping += weight * (undamped - normal) * (gap - gap0);
        }
    }
}

static int runs(int count, int length) { return (count + length - 1) / length; }

/* Number of boxes over a list of `count`. */
EXPORT int gw_contact_boxes(int count)
{
    int total = 0;
    for (int level = 0, length = RUN; level < LEVELS; level++, length *= RUN) total += runs(count, length);
    return total;
}

static void clear(const Boxes *b)
{
    for (int i = 0; i < gw_contact_boxes(b->count); i++) {
        b->box[4 * i] = b->box[4 * i + 1] = 1e300;
        b->box[4 * i + 2] = b->box[4 * i + 3] = -1e300;
    }
}

/* Make room for item i's point (x, y) in all boxes over it. */
static void cover(const Boxes *b, int i, double x, double y)
{
    double *box = b->box;
    for (int level = 0, length = RUN; level < LEVELS; box += 4 * runs(b->count, length), level++, length *= RUN) {
        double *here = box + 4 * (i / length);
        if (x < here[0]) here[0] = x;
        if (y < here[1]) here[1] = y;
        if (x > here[2]) here[2] = x;
        if (y > here[3]) here[3] = y;
    }
}

/* The first item from i on whose runs are not apart from the rectangle about (x, y), half as large as (dx, dy). */
static int next_near(const Boxes *b, int i, double x, double y, double dx, double dy)
{
    while (i < b->count && i % RUN == 0) {
        const double *box = b->box;
        int far = 0;
        for (int level = 0, length = RUN; level < LEVELS && i % length == 0; box += 4 * runs(b->count, length), level++, length *= RUN) {
            const double *here = box + 4 * (i / length);
            if (here[0] <= x + dx && here[2] >= x - dx && here[1] <= y + dy && here[3] >= y - dy) break;
            far = length;
        }
        if (far == 0) break;
        i += far;
    }
    return i;
}

static Boxes boxes_of_walls(const System *sys) { const Boxes b = {sys->walls, sys->wall_boxes}; return b; }
static Boxes boxes_of_corners(const System *sys) { const Boxes b = {sys->corners, sys->corner_boxes}; return b; }

/* Fill the boxes of walls and corners, which do not move: once, before anything else. */
EXPORT void gw_contact_index(const System *sys)
{
    const Boxes walls = boxes_of_walls(sys), corners = boxes_of_corners(sys);
    clear(&walls);
    clear(&corners);
    for (int w = 0; w < sys->walls; w++) {
        const double lo = sys->wall_lo[w] < 0 ? sys->wall_lo[w] : 0, length = sys->wall_length[w], hi = sys->wall_hi[w] > length ? sys->wall_hi[w] : length;
        cover(&walls, w, sys->wall_x[w] + lo * sys->wall_tx[w], sys->wall_y[w] + lo * sys->wall_ty[w]);
        cover(&walls, w, sys->wall_x[w] + hi * sys->wall_tx[w], sys->wall_y[w] + hi * sys->wall_ty[w]);
    }
    for (int k = 0; k < sys->corners; k++) cover(&corners, k, sys->corner_x[k], sys->corner_y[k]);
}

static int append(Pairs *p, int body, int target, double side)
{
    if (p->count >= p->capacity) return 0;
    p->body[p->count] = body;
    p->target[p->count] = target;
    p->side[p->count] = side;
    p->start[p->count] = p->held[p->count] = p->weight[p->count] = 0;
    p->normal[p->count] = p->tangential[p->count] = p->energy[p->count] = p->slip[p->count] = p->elastic[p->count] = 0;
    p->normal_stiffness[p->count] = p->tangential_stiffness[p->count] = 0;
    p->line[p->count] = p->slope[p->count] = p->was_line[p->count] = p->was_slope[p->count] = 0;
    p->count++;
    return 1;
}

/* Side on which a corner lies for a body: what was decided when the tip passed it for the stretch of wire that runs past it,
 * `window` bodies either way of the nearest; where a fold of the wire comes by once more, the side on which it lies there. */
static double side_for(const double *sides, const int *nearest, int corner, int body, int window, double y)
{
    const int away = body - nearest[corner];
    if (nearest[corner] < 0 || (away <= window && away >= -window)) return sides[corner];
    return y < 0 ? -1 : 1;
}

/* Pairs that can touch within sys->reach of travel. `first`: the first body whose node is in the vessel, not in the catheter.
 * A node takes part with a wall only from its lumen side, a segment with a corner only from the side it passed on: what lies
 * across a thin septum is not met. `sides` (corners) as in Pairs, `nearest` (corners) as gw_contact_nearest gives it. Returns 0 when a list is full. */
EXPORT int gw_contact_candidates(const System *sys, const Motion *m, const double *sides, const int *nearest, int first,
                                 Pairs *nodes, Pairs *corners)
{
    const double reach = sys->reach, limit = sys->radius + sys->toe + reach, around = limit + reach;
    const Boxes walls = boxes_of_walls(sys), lips = boxes_of_corners(sys);
    nodes->count = corners->count = 0;
    nodes->near_count = corners->near_count = -1;
    for (int b = 0; b < sys->bodies; b++) {
        const double h = sys->half_length[b], px = m->q[3 * b] + h * m->c[b], py = m->q[3 * b + 1] + h * m->s[b];
        for (int w = next_near(&walls, 0, px, py, around, around); w < sys->walls; w = next_near(&walls, w + 1, px, py, around, around)) {
            if (sys->wall_tube[w] != (b < first)) continue;
            const double tx = sys->wall_tx[w], ty = sys->wall_ty[w], rx = px - sys->wall_x[w], ry = py - sys->wall_y[w];
            const double height = -ty * rx + tx * ry, along = tx * rx + ty * ry;
            if (height > limit || height < -limit || along < sys->wall_lo[w] - reach || along > sys->wall_hi[w] + reach) continue;
            if (height < 0 && !(along < 0 && (sys->wall_sharp[w] & 1)) && !(along > sys->wall_length[w] && (sys->wall_sharp[w] & 2))) continue;
            if (!append(nodes, b, w, 0)) return 0;
        }
        const double x0 = m->q[3 * b], y0 = m->q[3 * b + 1], c = magnitude(m->c[b]), s = magnitude(m->s[b]);
        const double wide = h * c + 2 * limit, high = h * s + 2 * limit;
        for (int k = next_near(&lips, 0, x0, y0, wide, high); k < sys->corners; k = next_near(&lips, k + 1, x0, y0, wide, high)) {
            if (b < first && !sys->corner_tube[k]) continue;
            const double dx = sys->corner_x[k] - x0, dy = sys->corner_y[k] - y0;
            const double x = dx * m->c[b] + dy * m->s[b], y = -dx * m->s[b] + dy * m->c[b], over = magnitude(x) - h;
            if (over > limit || y > limit || y < -limit) continue;
            const double side = side_for(sides, nearest, k, b, 2 + (int)(2 * limit / h), y);
            if (side * y < 0 && over <= 0) continue;
            if (!append(corners, b, k, side)) return 0;
        }
    }
    return 1;
}

static Boxes boxes_of_bodies(const System *sys, const Motion *m)
{
    const Boxes b = {sys->bodies, sys->body_boxes};
    clear(&b);
    for (int i = 0; i < sys->bodies; i++) {
        const double ax = sys->half_length[i] * m->c[i], ay = sys->half_length[i] * m->s[i];
        cover(&b, i, m->q[3 * i] - ax, m->q[3 * i + 1] - ay);
        cover(&b, i, m->q[3 * i] + ax, m->q[3 * i + 1] + ay);
    }
    return b;
}

/* For each corner the nearest body (the first of equals, -1: none), and whether the corner lies ahead of the tip (1) or
 * beside the wire (0). The body nearest to the corner before is a good guess: what is further away need not be looked at. */
EXPORT void gw_contact_nearest(const System *sys, const Motion *m, int first, int *body, int *ahead, double *offset)
{
    const Boxes bodies = boxes_of_bodies(sys, m);
    int guess = sys->bodies - 1;
    for (int k = 0; k < sys->corners; k++) {
        const int from = sys->corner_tube[k] ? 0 : first;
        const double cx = sys->corner_x[k], cy = sys->corner_y[k];
        double best = 1e300, reach = 1e150;
        body[k] = -1;
        if (guess < from) guess = sys->bodies - 1;
        for (int b = from < sys->bodies ? guess : sys->bodies, guessed = 1; b < sys->bodies; guessed = 0) {
            const Place pl = corner_place(sys, m, b, cx, cy, 0);
            const double d = pl.over * pl.over + pl.y * pl.y;
            if (d < best || (d == best && b < body[k])) {
                best = d;
                reach = square_root(d) * (1 + 1e-9);
                body[k] = b;
                ahead[k] = b == sys->bodies - 1 && pl.over > 0;
                offset[k] = pl.y;
            }
            b = next_near(&bodies, guessed ? from : b + 1, cx, cy, reach, reach);
        }
        if (body[k] >= 0) guess = body[k];
    }
}

/* What the pairs of one body add to the curvature of the chain's potential, about the body's proximal joint. */
typedef struct { double pp[3], pa[2], aa, force[2]; } Curvature;    /* pp: xx, xy, yy */

static void add_spring(Curvature *k, double stiffness, double dx, double dy, double lever, double nx, double ny)
{
    const double along = lever * (dx * nx + dy * ny);
    k->pp[0] += stiffness * dx * dx;
    k->pp[1] += stiffness * dx * dy;
    k->pp[2] += stiffness * dy * dy;
    k->pa[0] += stiffness * dx * along;
    k->pa[1] += stiffness * dy * along;
    k->aa += stiffness * along * along;
}

static void add_node(const System *sys, const Motion *m, const Pairs *p, int i, Curvature *k)
{
    const int b = p->body[i], w = p->target[i];
    const double lever = 2 * sys->half_length[b], tx = sys->wall_tx[w], ty = sys->wall_ty[w];
    const double normal = p->weight[i] * p->normal[i], tangential = p->weight[i] * p->tangential[i];
    const double fx = -ty * normal + tx * tangential, fy = tx * normal + ty * tangential;
    add_spring(k, p->normal_stiffness[i], -ty, tx, lever, -m->s[b], m->c[b]);
    add_spring(k, p->tangential_stiffness[i], tx, ty, lever, -m->s[b], m->c[b]);
    k->force[0] += fx;
    k->force[1] += fy;
    k->aa += lever * (m->c[b] * fx + m->s[b] * fy);
}

static void add_corner(const System *sys, const Motion *m, const Pairs *p, int i, Curvature *k)
{
    const int b = p->body[i], c = p->target[i];
    const double cb = m->c[b], sb = m->s[b], h = sys->half_length[b];
    const Place pl = corner_place(sys, m, b, sys->corner_x[c], sys->corner_y[c], p->side[i]);
    const double ux = pl.ux * cb - pl.uy * sb, uy = pl.ux * sb + pl.uy * cb;
    const double tx = pl.tx * cb - pl.ty * sb, ty = pl.tx * sb + pl.ty * cb;
    const double lever = h + pl.foot, normal = p->weight[i] * p->normal[i], tangential = p->weight[i] * p->tangential[i];
    add_spring(k, p->normal_stiffness[i], ux, uy, lever, -sb, cb);
    add_spring(k, p->tangential_stiffness[i] - normal * pl.curvature, tx, ty, lever, -sb, cb);
    const double fx = -normal * ux + tangential * tx, fy = -normal * uy + tangential * ty;
    k->force[0] += fx;
    k->force[1] += fy;
    if (pl.over == 0) {                             /* beside the segment the normal turns with it */
        k->pa[0] -= normal * pl.uy * cb;
        k->pa[1] -= normal * pl.uy * sb;
        k->aa += normal * pl.distance + lever * tangential;
    } else {
        k->aa += lever * (cb * fx + sb * fy);
    }
}

/* Number of directions in which the converged step is a maximum, not a minimum, of the chain's incremental potential.
 * The angles are eliminated from the tip to the catheter; each pivot is the curvature left in one angle (Sylvester's law of
 * inertia). joint_stiffness (bodies): N m/rad of the joint at the proximal end, with the damper's share of this step. */
EXPORT int gw_contact_unstable(const System *sys, const Motion *m, const Pairs *nodes, const Pairs *corners, const double *joint_stiffness)
{
    double pp[3] = {0, 0, 0}, pa[2] = {0, 0}, aa = 0, tail[2] = {0, 0};   /* value of the distal part: place of its joint, angle before it */
    int negative = 0, i = nodes->near_count - 1, j = corners->near_count - 1;
    for (int b = sys->bodies - 1; b >= 0; b--) {
        Curvature k = {{0, 0, 0}, {0, 0}, 0, {0, 0}};
        for (; i >= 0 && nodes->body[nodes->near[i]] == b; i--) if (nodes->normal[nodes->near[i]] > 0) add_node(sys, m, nodes, nodes->near[i], &k);
        for (; j >= 0 && corners->body[corners->near[j]] == b; j--) if (corners->normal[corners->near[j]] > 0) add_corner(sys, m, corners, corners->near[j], &k);
        const double length = 2 * sys->half_length[b], nx = -m->s[b], ny = m->c[b], stiffness = joint_stiffness[b];
        const double px = pp[0] * nx + pp[1] * ny, py = pp[1] * nx + pp[2] * ny;
        const double ax = length * px + pa[0] + k.pa[0], ay = length * py + pa[1] + k.pa[1];
        const double pivot = stiffness + k.aa + length * (m->c[b] * tail[0] + m->s[b] * tail[1])
                           + length * length * (nx * px + ny * py) + 2 * length * (nx * pa[0] + ny * pa[1]) + aa;
        if (pivot <= 0) negative++;
        const double inverse = pivot != 0 ? 1 / pivot : 0;
        pp[0] += k.pp[0] - ax * ax * inverse;
        pp[1] += k.pp[1] - ax * ay * inverse;
        pp[2] += k.pp[2] - ay * ay * inverse;
        pa[0] = stiffness * ax * inverse;
        pa[1] = stiffness * ay * inverse;
        aa = stiffness - stiffness * stiffness * inverse;
        tail[0] += k.force[0];
        tail[1] += k.force[1];
    }
    return negative;
}

static double cross(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

/* The first wire segment whose axis crosses a wall of the catheter or, from body `first` on, of the vessel: it has left there.
 * Returns the body, or -1; *wall is the wall crossed. Open ends are no walls, so leaving through them is no crossing. */
EXPORT int gw_contact_crossing(const System *sys, const Motion *m, int first, int *wall)
{
    const Boxes walls = boxes_of_walls(sys);
    for (int b = 0; b < sys->bodies; b++) {
        const double h = sys->half_length[b], dx = 2 * h * m->c[b], dy = 2 * h * m->s[b];
        const double x = m->q[3 * b] - 0.5 * dx, y = m->q[3 * b + 1] - 0.5 * dy;
        const double wide = h * magnitude(m->c[b]) + sys->radius, high = h * magnitude(m->s[b]) + sys->radius;
        const double x0 = m->q[3 * b], y0 = m->q[3 * b + 1];
        for (int w = next_near(&walls, 0, x0, y0, wide, high); w < sys->walls; w = next_near(&walls, w + 1, x0, y0, wide, high)) {
            if (b < first && !sys->wall_tube[w]) continue;
            const double tx = sys->wall_tx[w], ty = sys->wall_ty[w], length = sys->wall_length[w];
            const double ax = x - sys->wall_x[w], ay = y - sys->wall_y[w];
            const double side0 = cross(tx, ty, ax, ay), side1 = cross(tx, ty, ax + dx, ay + dy);
            if ((side0 >= 0) == (side1 >= 0)) continue;
            const double u = side0 / (side0 - side1), along = (ax + u * dx) * tx + (ay + u * dy) * ty;
            if (along >= 0 && along <= length) {
                *wall = w;
                return b;
            }
        }
    }
    return -1;
}
