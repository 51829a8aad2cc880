/*
 * Memory for static placement, bytes: upper bounds as integer constant expressions, not much above what nekton_model_req and
 * nekton_sim_req tell for the plain quadrature, up to some times that for the graded one on small scenes.
 *
 *   static union { uint64_t align; unsigned char bytes[NEKTON_MODEL_BYTES(1, 2, 32, 0, 0, 0, 0, 2, 0)]; } memory;
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
 * graded:         0 for NEKTON_QUADRATURE_PLAIN; for NEKTON_QUADRATURE_GRADED 1, and 2 if there is repulsion
 *
 * Names with NEKTON_P_ are parts of these.
 */
#define NEKTON_P_S(x) ((size_t)(x))
#define NEKTON_P_SQ(x) (NEKTON_P_S(x) * NEKTON_P_S(x))
#define NEKTON_P_L(bodies, joints) (NEKTON_P_S(bodies) + NEKTON_P_S(joints))
#define NEKTON_P_C(bodies, joints) (3 * NEKTON_P_S(bodies) + NEKTON_P_S(joints))
#define NEKTON_P_OUTLINE(points) (200 * NEKTON_P_S(points) + 8)
#define NEKTON_P_MOST(a, b) (NEKTON_P_S(a) > NEKTON_P_S(b) ? NEKTON_P_S(a) : NEKTON_P_S(b))
/* The potential of rotation, on twice the nodes where they will move. */
#define NEKTON_P_BUILD(points, nodes, graded) \
    (NEKTON_P_S(points) == 0 ? 5 * NEKTON_P_S(nodes) + 80 \
                             : ((graded) ? 8 : 2) * NEKTON_P_SQ(nodes) + 26 * NEKTON_P_S(nodes) + NEKTON_P_SQ(points) + \
                                   144 * NEKTON_P_S(points) + 80)
/* Rungs of one boundary, beyond the permanent ones. */
#define NEKTON_P_RUNGS(nodes) (7 * NEKTON_P_MOST(nodes, 24) + 4)
/* What graded quadrature adds to a model: pole tables, ladders, tips, modes; ladders that walls cause on each other; repulsion. */
#define NEKTON_P_MODEL_GRADED(boundaries, nodes, walls, wall_nodes, points, graded) \
    (NEKTON_P_S((graded) != 0) * \
         ((boundaries) * (6 * NEKTON_P_MOST(nodes, wall_nodes) + 4 + 3 * NEKTON_P_S(points) + NEKTON_P_MOST(points, 32)) + \
          NEKTON_P_S(walls) * (NEKTON_P_RUNGS(wall_nodes) + 150)) + \
     NEKTON_P_S((graded) == 2) * 5400)
/* The same for a simulation: nodes, rungs, ladders, preimages. */
#define NEKTON_P_SIM_GRADED(boundaries, u, nodes, wall_nodes, points, graded) \
    (NEKTON_P_S((graded) != 0) * \
     (8 * (u) + (boundaries) * (2 * NEKTON_P_RUNGS(NEKTON_P_MOST(nodes, wall_nodes)) + NEKTON_P_OUTLINE(points) + 74) + \
      14 * (boundaries) * (u)))
#define NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded) \
    (NEKTON_P_L(bodies, joints) * (8 * NEKTON_P_S(nodes) + (1 + NEKTON_P_S((circulation) && NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls) > 1)) * NEKTON_P_SQ(nodes)) + \
     7 * NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes) + \
     (1 + NEKTON_P_S(circulation)) * NEKTON_P_SQ(NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes)) + \
     (NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls)) * NEKTON_P_OUTLINE(points) + \
     NEKTON_P_BUILD(points, NEKTON_P_S(nodes), graded) + 4 * NEKTON_P_S(rows) + \
     NEKTON_P_MODEL_GRADED(NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls), nodes, walls, wall_nodes, points, graded))
#define NEKTON_P_MODEL_RECORDS(bodies, joints, walls) \
    (640 + 544 * NEKTON_P_L(bodies, joints) + 128 * NEKTON_P_C(bodies, joints) + 400 * NEKTON_P_S(walls))
#define NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes) \
    (NEKTON_P_L(bodies, joints) * NEKTON_P_S(nodes) + NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes))
#define NEKTON_P_KEPT(bodies, joints, walls, channels) \
    (48 * NEKTON_P_C(bodies, joints) + 11 * NEKTON_P_L(bodies, joints) + 4 * NEKTON_P_S(walls) + 8 * NEKTON_P_S(channels) + 40)
#define NEKTON_P_EVALUATION(l, c, u, circulation, walls, channels) \
    (34 * (l) + 4 * NEKTON_P_S(walls) + 8 * NEKTON_P_S(channels) + 4 * (c) + 9 * (l) * ((c) + 1) + (c) * ((c) + 2) + \
     ((u) + 15) * ((u) + (c) + 1) + 13 * (u) + 20 + NEKTON_P_S(circulation) * (u) * ((u) + 7))
#define NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded) \
    (2 * NEKTON_P_KEPT(bodies, joints, walls, channels) + \
     NEKTON_P_EVALUATION(NEKTON_P_L(bodies, joints), NEKTON_P_C(bodies, joints), \
                         NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes), circulation, walls, channels) + \
     NEKTON_P_SIM_GRADED(NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls), \
                         NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes), nodes, wall_nodes, points, graded))

#define NEKTON_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded) \
    (NEKTON_P_MODEL_RECORDS(bodies, joints, walls) + \
     8 * NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded))
#define NEKTON_SIM_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded) \
    (1024 + 8 * NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded))

/*
 * Filled by their own size: nekton_link_def_init(&link). What is in the library is the function of the same name, which takes size and
 * version too: (nekton_link_def_init)(&link, sizeof link, NEKTON_ABI_VERSION), as other languages call it.
 */
#define nekton_wall_def_init(def) nekton_wall_def_init((def), sizeof(nekton_wall_def), NEKTON_ABI_VERSION)
#define nekton_body_def_init(def) nekton_body_def_init((def), sizeof(nekton_body_def), NEKTON_ABI_VERSION)
#define nekton_link_def_init(def) nekton_link_def_init((def), sizeof(nekton_link_def), NEKTON_ABI_VERSION)
#define nekton_method_init(def) nekton_method_init((def), sizeof(nekton_method), NEKTON_ABI_VERSION)
