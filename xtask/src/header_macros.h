/*
 * Memory for static placement, bytes: upper bounds as integer constant expressions, not much above what nekton_model_req and
 * nekton_sim_req tell.
 *
 *   static union { uint64_t align; unsigned char bytes[NEKTON_MODEL_BYTES(1, 2, 32, 0, 0, 0, 0, 2)]; } memory;
 *
 * bodies, joints: numbers; a body of n links has n - 1 joints
 * nodes:          largest number of nodes on a link (NEKTON_SIM_BYTES: 0 for a lone rigid body or without fluid)
 * walls:          number of obstacles, and one for a tank
 * wall_nodes:     largest number of nodes on a wall
 * circulation:    1 if some circulation is not 0, else 0
 * points:         0 if every outline is an ellipse; 1 if some are stars; 4 if some are rectangles; the largest number of
 *                 corners or points if some are polygons or curves
 * rows:           harmonic terms and table rows of all signals together
 * channels:       number of signals set while running
 *
 * Names with NEKTON_P_ are parts of these.
 */
#define NEKTON_P_S(x) ((size_t)(x))
#define NEKTON_P_SQ(x) (NEKTON_P_S(x) * NEKTON_P_S(x))
#define NEKTON_P_L(bodies, joints) (NEKTON_P_S(bodies) + NEKTON_P_S(joints))
#define NEKTON_P_C(bodies, joints) (3 * NEKTON_P_S(bodies) + NEKTON_P_S(joints))
#define NEKTON_P_OUTLINE(points) (170 * NEKTON_P_S(points) + 8)
#define NEKTON_P_BUILD(points, nodes) \
    (NEKTON_P_S(points) == 0 ? 5 * NEKTON_P_S(nodes) \
                             : NEKTON_P_SQ(nodes) + 5 * NEKTON_P_S(nodes) + NEKTON_P_SQ(points) + 144 * NEKTON_P_S(points))
#define NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows) \
    (NEKTON_P_L(bodies, joints) * (6 * NEKTON_P_S(nodes) + (1 + NEKTON_P_S(circulation)) * NEKTON_P_SQ(nodes)) + \
     5 * NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes) + \
     (1 + NEKTON_P_S(circulation)) * NEKTON_P_SQ(NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes)) + \
     (NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls)) * NEKTON_P_OUTLINE(points) + \
     NEKTON_P_BUILD(points, NEKTON_P_S(nodes)) + 4 * NEKTON_P_S(rows))
#define NEKTON_P_MODEL_RECORDS(bodies, joints, walls) \
    (512 + 408 * NEKTON_P_L(bodies, joints) + 128 * NEKTON_P_C(bodies, joints) + 264 * NEKTON_P_S(walls))
#define NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes) \
    (NEKTON_P_L(bodies, joints) * NEKTON_P_S(nodes) + NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes))
#define NEKTON_P_KEPT(bodies, joints, walls, channels) \
    (48 * NEKTON_P_C(bodies, joints) + 11 * NEKTON_P_L(bodies, joints) + 4 * NEKTON_P_S(walls) + 8 * NEKTON_P_S(channels) + 24)
#define NEKTON_P_EVALUATION(l, c, u, circulation, walls, channels) \
    (34 * (l) + 4 * NEKTON_P_S(walls) + 8 * NEKTON_P_S(channels) + 4 * (c) + 9 * (l) * ((c) + 1) + (c) * ((c) + 2) + \
     ((u) + 8) * ((u) + (c) + 1) + 13 * (u) + 2 + NEKTON_P_S(circulation) * (u) * ((u) + 7))
#define NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels) \
    (2 * NEKTON_P_KEPT(bodies, joints, walls, channels) + \
     NEKTON_P_EVALUATION(NEKTON_P_L(bodies, joints), NEKTON_P_C(bodies, joints), \
                         NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes), circulation, walls, channels))

#define NEKTON_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows) \
    (NEKTON_P_MODEL_RECORDS(bodies, joints, walls) + \
     8 * NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows))
#define NEKTON_SIM_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, channels) \
    (1024 + 8 * NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels))
#define NEKTON32_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows) \
    (NEKTON_P_MODEL_RECORDS(bodies, joints, walls) + \
     4 * NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows))
#define NEKTON32_SIM_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, channels) \
    (1024 + 4 * NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels))
