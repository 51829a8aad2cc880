classdef Nekton < handle
%NEKTON  Rigid and articulated bodies moving in a 2D ideal fluid.
%   sim = NEKTON(scene) starts a simulation at time 0. scene is a struct (see nekton_scene) or the name of a scene file
%   (see nekton_scene_file).
%
%   sim = NEKTON(scene, name, value, ...) with the options
%     'method'        'adams' (default: variable step and order), 'rk4', 'abm4' (fixed step) or 'gauss6' (fixed step,
%                     implicit, for long runs: the energy does not drift)
%     'tolerance'     of 'adams', relative and absolute (default: the scene's, else 1e-9)
%     'step'          of 'rk4', 'abm4' and 'gauss6' (default: the scene's)
%     'MaxStep'       longest step of 'adams' (default: none)
%     'InitialStep'   first step of 'adams' to be tried (default: chosen by itself)
%     'controls'      function [c, dc, ddc] = f(t) with the joint angles (or torques) of all joints that no motion is given for,
%                     and their first and second derivative: columns, in the order of jointNames
%     'control_step'  time between two calls of it (default 0.05); the angles are quintic in between, so the error is of
%                     order 6 in it. It is called once for every multiple of this time, and by rhs.
%     'parameters'    second argument of the controls, f(t, parameters), if given
%
%   sim.step              one step of the method (with controls: one control_step)
%   sim.advance(t)        to exactly time t
%   sim.show(t, t_stop)   the same, cheaper when output is wanted at many times up to t_stop
%   sim.setStepLimit(n)   steps that one such call may make (at first 1e6)
%   bytes = sim.toBytes   all that it remembers; sim.fromBytes(bytes) of an equal scene, also in another session, goes on from there
%   [y, t] = sim.state    integrated state;  sim.setState(t, y) sets it
%   dy = sim.rhs(t, y)    its rate, for ode45, ode113, lsode; the simulation does not change
%   sim.time, sim.positions, sim.velocities    3 x links: x, y, theta of the centres of mass, and their rates
%   sim.massMatrix, sim.addedMass, sim.christoffel, sim.gyroscopic    at the present state
%   [A, B, bound] = sim.linearize(names)    derivatives of the rates by state and parameters (see help Nekton.linearize)
%   sim.energy            struct: kinetic_fluid, kinetic_bodies, buoyancy, repulsion, circulation, total, work
%   sim.impulse           linear x, y and angular about the origin
%   [tau, power] = sim.torques    of all joints;  [u, du] = sim.joints
%   [d, places] = sim.gap         smallest distance between two boundaries
%   sim.plot              draws bodies and walls;  sim.animate(t) draws while advancing (see help Nekton.animate)
%
%   Errors have identifiers nekton:group:name; a call that fails leaves the simulation as it was, but advance and show keep the
%   steps that they made before: sim.time tells how far they came. Units are SI per unit depth.
%
%   clear sim, or delete(sim), frees the memory.
%
%   See also NEKTON_SCENE, DEMO_FISH, BHT_TRAJECT_COMPUTE.

    properties (SetAccess = private)
        plan         % what is computed, and lengths of arrays
        links        % struct array by link: body, link, name, nodes, mass, inertia, area, perimeter, centroid
        jointNames   % cell of texts: body.link of the link that each joint moves
        obstacles    % number of obstacles
        hasTank      % true if there is a tank
        run          % the scene's struct run
        controlStep  % time between two calls of the controls
    end
    properties (Access = private)
        id           % handle of nekton_mex
        guard        % frees it
        control      % function [c, dc, ddc] = f(t), or []
        last         % time and controls at the end of the interval that is set: {t, [c dc ddc]}
    end

    methods
        function self = Nekton(scene, varargin)
            options = struct('method', '', 'tolerance', [], 'step', [], 'MaxStep', [], 'InitialStep', [], 'controls', [], 'control_step', 0.05, 'parameters', []);
            given = {};
            for k = 1:2:numel(varargin)
                if k == numel(varargin) || ~ischar(varargin{k}) || ~isfield(options, varargin{k})
                    error('nekton:arg:option', 'options are pairs of name and value: %s', ...
                        strtrim(sprintf('%s ', 'method', 'tolerance', 'step', 'MaxStep', 'InitialStep', 'controls', 'control_step', 'parameters')));
                end
                options.(varargin{k}) = varargin{k + 1};
                given{end + 1} = varargin{k}; %#ok<AGROW>
            end
            if ischar(scene)
                scene = nekton_scene_file(scene);
            end
            f = options.controls;
            if ischar(f) && ~isempty(f)
                f = str2func(f);
            end
            if ~isempty(f) && ~isa(f, 'function_handle')
                error('nekton:arg:class', 'controls must be a function handle');
            end
            if any(strcmp(given, 'parameters')) && ~isempty(f)
                p = options.parameters;
                f = @(t) f(t, p);
            end
            h = options.control_step;
            if ~(isnumeric(h) && isscalar(h) && isreal(h) && h > 0 && isfinite(h))
                error('nekton:arg:range', 'control_step must be positive');
            end
            [scene, names, self.run] = nekton_scene(scene, ~isempty(f));
            method = Nekton.chooseMethod(options, self.run);
            self.control = f;
            self.controlStep = h;
            self.last = {};

            if ~isempty(f)
                % A lone swimmer's impulse is fixed when it is created, before any control is set.
                c = Nekton.evaluate(f, 0);
                moving = any(arrayfun(@(b) any(b.velocity ~= 0), scene.bodies));
                if any(c(:, 2) ~= 0) || moving && any(c(:, 1) ~= 0)
                    scene.shortcuts = 0;
                end
            end
            self.id = nekton_mex('create', scene, method{:});
            id = self.id;
            self.guard = onCleanup(@() Nekton.release(id));
            self.plan = nekton_mex('plan', id);
            self.jointNames = names.joint;
            self.hasTank = isfield(scene, 'tank');
            self.obstacles = 0;
            if isfield(scene, 'obstacles')
                self.obstacles = numel(scene.obstacles);
            end
            facts = nekton_mex('links', id);
            for k = size(facts, 1):-1:1
                x = facts(k, :);
                list(k) = struct('body', x(1), 'link', x(2), 'name', [names.body{k} '.' names.link{k}], 'nodes', x(3), ...
                    'mass', x(4), 'inertia', x(5), 'area', x(6), 'perimeter', x(7), 'centroid', x(8:9));
            end
            self.links = list;
            for notice = nekton_mex('notices', id)'
                warning('nekton:scene:notice', '%s', notice{1});
            end
            if self.plan.channels > 0
                if isempty(f)
                    error('nekton:arg:controls', 'the scene has joints moved by controls: give the option controls');
                end
                self.prepare(h);
                [y, t] = nekton_mex('state', id);
                nekton_mex('set_state', id, t, y);
            end
        end

        function delete(self)
            self.guard = [];
        end

        function step(self)
        %STEP  One step of the method; with controls, one control step.
            if self.plan.channels > 0
                self.advance(self.time() + self.controlStep);
            else
                nekton_mex('step', self.id);
            end
        end

        function advance(self, t_end)
        %ADVANCE  Advance to exactly time t_end; nothing is evaluated beyond it (controls: but for the end of a control step).
            if self.plan.channels == 0
                nekton_mex('advance', self.id, t_end);
                return
            end
            if ~(isnumeric(t_end) && isscalar(t_end) && isreal(t_end) && isfinite(t_end))
                error('nekton:arg:finite', 'advance: the time must be a finite number');
            end
            t = self.time();
            if t_end < t
                error('nekton:sim:PastTime', 'advance: %g lies before the present time %g', t_end, t);
            end
            while t < t_end
                n = floor(t / self.controlStep * (1 + 4 * eps)) + 1;
                next = n * self.controlStep;
                self.prepare(next);
                nekton_mex('advance', self.id, min(next, t_end));
                t = self.time();
            end
        end

        function show(self, t, t_stop)
        %SHOW  show(t, t_stop) shows the state at time t; the integrator may run ahead, but not beyond t_stop. Cheaper than advance
        %   when output is wanted at many times. With controls it is the same as advance.
            if self.plan.channels > 0
                self.advance(t);
            else
                nekton_mex('advance_dense', self.id, t, t_stop);
            end
        end

        function setStepLimit(self, n)
        %SETSTEPLIMIT  Steps that one call of advance or show (with controls: one control step) may make before it ends with the
        %   error nekton:sim:TooManySteps; at first 1e6.
            nekton_mex('step_limit', self.id, n);
        end

        function bytes = toBytes(self)
        %TOBYTES  All that the simulation remembers (state, method, past of the integrator, counters, estimates) as a row of class
        %   uint8. With controls at the end of a control step only.
            % Between commands the object remembers more than the simulation does.
            if self.plan.channels > 0 && (isempty(self.last) || self.last{3} ~= self.command(self.time()))
                error('nekton:sim:Unsupported', ...
                    'toBytes: with controls, advance to a multiple of control_step (%g) first', self.controlStep);
            end
            bytes = nekton_mex('save', self.id);
        end

        function fromBytes(self, bytes)
        %FROMBYTES  fromBytes(bytes) makes the simulation what toBytes gave, here or in another session, to the bit. The scenes must
        %   be equal in every value, and so must be the controls; the method is that of the bytes. Bytes of another scene and damaged ones are
        %   refused with nekton:sim:BadSave, and nothing changes.
            if self.plan.channels == 0
                nekton_mex('load', self.id, bytes);
                return
            end
            before = nekton_mex('save', self.id);
            nekton_mex('load', self.id, bytes);
            try
                t = self.command(self.time());
                self.last = {t, [], t, Nekton.evaluate(self.control, t)};
            catch problem
                nekton_mex('load', self.id, before);
                rethrow(problem);
            end
        end

        function t = time(self)
        %TIME  Time of the state shown, s.
            t = nekton_mex('time', self.id);
        end

        function q = positions(self)
        %POSITIONS  3 x links: x, y, theta of the centre of mass.
            q = nekton_mex('positions', self.id);
        end

        function v = velocities(self)
        %VELOCITIES  3 x links: rates of x, y, theta.
            v = nekton_mex('velocities', self.id);
        end

        function [y, t] = state(self)
        %STATE  Integrated state: free coordinates, their rates (not for a lone swimmer), and the work of the drives if any.
            [y, t] = nekton_mex('state', self.id);
        end

        function setState(self, t, y)
        %SETSTATE  setState(t, y) sets time and state as state gives them.
            if self.plan.channels == 0
                nekton_mex('set_state', self.id, t, y);
                return
            end
            if ~(isnumeric(t) && isscalar(t) && isreal(t) && isfinite(t))
                error('nekton:arg:finite', 't must be finite');
            end
            [before, at] = nekton_mex('state', self.id);
            kept = self.last;
            start = floor(t / self.controlStep * (1 + 4 * eps)) * self.controlStep;
            try
                self.interval(start, start + self.controlStep);
                nekton_mex('set_state', self.id, t, y);
            catch problem
                if ~isempty(kept)
                    nekton_mex('channels', self.id, kept{1}, kept{2}, kept{3}, kept{4});
                    self.last = kept;
                    nekton_mex('set_state', self.id, at, before);
                end
                rethrow(problem);
            end
        end

        function dy = rhs(self, t, y)
        %RHS  dy = rhs(t, y): rate of the state y at time t, for an integrator of your own. The simulation does not change.
        %   lsode keeps its last function, and with it the simulation, for ever; Octave then crashes on exit. Call
        %   lsode(@(y, t) 0, 0, [0 1]) when done.
            if self.plan.channels > 0
                dy = nekton_mex('rhs', self.id, t, y, Nekton.evaluate(self.control, t));
            else
                dy = nekton_mex('rhs', self.id, t, y);
            end
        end

        function M = massMatrix(self)
        %MASSMATRIX  Mass matrix of bodies and fluid, (3 links) x (3 links).
            M = nekton_mex('mass_matrix', self.id);
        end

        function M = addedMass(self)
        %ADDEDMASS  Added mass of the fluid, (3 links) x (3 links).
            M = nekton_mex('added_mass', self.id);
        end

        function f = christoffel(self)
        %CHRISTOFFEL  Force quadratic in the velocities, 3 links.
            f = nekton_mex('christoffel', self.id);
        end

        function G = gyroscopic(self)
        %GYROSCOPIC  Antisymmetric matrix of the force G v of circulation.
            G = nekton_mex('gyroscopic', self.id);
        end

        function a = accelerations(self)
        %ACCELERATIONS  3 x links.
            a = reshape(nekton_mex('accelerations', self.id), 3, []);
        end

        function f = force(self, name)
        %FORCE  force('buoyancy'), force('repulsion'), force('circulation'): gradient of that energy, 3 links.
            if ~ischar(name) || ~any(strcmp(name, {'buoyancy', 'repulsion', 'circulation'}))
                error('nekton:arg:word', 'force: buoyancy, repulsion or circulation');
            end
            f = nekton_mex(name, self.id);
        end

        function [A, B, bound] = linearize(self, names)
        %LINEARIZE  [A, B, bound] = linearize(names): derivatives of rhs at the state shown, A by the state and B by the
        %   parameters named in the cell array names, a column each; bound of their relative error in space. Exact derivatives, no
        %   differences; the simulation does not change. names may be left out. There are, links counted as in sim.links and joints
        %   as in sim.jointNames,
        %     fluid_density, gravity
        %     link1.mass, link1.inertia                       masses of bodies; of the fluid nothing changes
        %     link1.force_x, link1.force_y, link1.torque      from outside, at the centre of mass
        %     joint1.torque, .stiffness, .damping, .rest      where a torque drives the joint; rest: unloaded value of its spring
        %     joint1.position, .rate, .acceleration           where its motion is given
        %   The force of circulation is differentiated by differences. With controls: of those in the control step that the time is in.
            if nargin < 2
                names = {};
            end
            if ~iscellstr(names)
                error('nekton:arg:class', 'linearize: the names must be a cell array of texts');
            end
            [known, rows] = self.parameters();
            chosen = zeros(numel(names), 3);
            for k = 1:numel(names)
                at = find(strcmp(names{k}, known));
                if isempty(at)
                    error('nekton:arg:parameter', 'linearize: there is no ''%s'', but %s', names{k}, ...
                        strtrim(sprintf('%s ', known{:})));
                end
                chosen(k, :) = rows(at, :);
            end
            [A, B, bound] = nekton_mex('linearize', self.id, chosen);
        end

        function e = energy(self)
        %ENERGY  Struct of energies, J/m; total - work is constant.
            e = nekton_mex('energy', self.id);
        end

        function p = impulse(self)
        %IMPULSE  Linear impulse x, y and angular impulse about the origin.
            p = nekton_mex('impulse', self.id);
        end

        function [torque, power] = torques(self)
        %TORQUES  Torque that drives each joint, and its power.
            [torque, power] = nekton_mex('torques', self.id);
        end

        function [u, du] = joints(self)
        %JOINTS  Angle (slider: distance) of each joint, and its rate.
            [u, du] = nekton_mex('joint_values', self.id);
        end

        function [distance, places] = gap(self)
        %GAP  Smallest distance between two boundaries of which one moves (Inf: there is only one), and the two places as rows
        %   (kind: 1 tank, 2 obstacle, 4 link; number of obstacle or body; link).
            [distance, places] = nekton_mex('gap', self.id);
        end

        function r = resolution(self)
        %RESOLUTION  Struct of relative error indicators of the space discretization now, from all of the added mass: mass, force,
        %   quadrature, repulsion, and bound, 100 times the largest of them.
            r = nekton_mex('resolution', self.id);
        end

        function r = indicators(self)
        %INDICATORS  The same of the steps, the largest since the call before the last step or advance: they come at almost no
        %   cost. If the scene's run.tolerance is exceeded, step and advance warn (nekton:sim:Unresolved), once until it is met again.
        %   So they do when the estimated error of a fixed step is a tenth of a body or more (nekton:sim:StepTooLong).
            r = nekton_mex('indicators', self.id);
        end

        function e = timeError(self)
        %TIMEERROR  Struct of estimated local errors of time integration since the start or the last setState: length (m), angle (rad),
        %   speed (m/s) and spin (rad/s) of the last step, length_sum, angle_sum, speed_sum and spin_sum of all steps, and unknown, the
        %   number of steps without estimate. NaN: no step was estimated ('gauss6' never is).
            e = nekton_mex('time_error', self.id);
        end

        function n = counters(self)
        %COUNTERS  Struct: evaluations, factorizations, steps, rejected.
            n = nekton_mex('counters', self.id);
        end

        function points = outline(self, kind, index, link, t)
        %OUTLINE  outline('link', body, link, t), outline('obstacle', k, 0, t), outline('tank', 0, 0, t): 2 x n points, links in
        %   their own frame with the centre of mass as origin, walls in the world.
            points = nekton_mex('outline', self.id, kind, [index, link], t);
        end

        function [outlines, walls] = outlines(self, n)
        %OUTLINES  Cells of 2 x n points: of the links where they are now, and of the walls (tank last).
            if nargin < 2
                n = 100;
            end
            t = linspace(0, 2 * pi, n);
            t(end) = 0;
            q = self.positions();
            outlines = cell(1, numel(self.links));
            for k = 1:numel(outlines)
                p = self.outline('link', self.links(k).body, self.links(k).link, t);
                c = cos(q(3, k));
                s = sin(q(3, k));
                outlines{k} = [c, -s; s, c] * p + q(1:2, k) * ones(1, n);
            end
            walls = cell(1, self.obstacles);
            for k = 1:self.obstacles
                walls{k} = self.outline('obstacle', k, 0, t);
            end
            if self.hasTank
                walls{end + 1} = self.outline('tank', 0, 0, t);
            end
        end

        function plot(self, limits)
        %PLOT  Draw bodies and walls into the present axes. plot([x0 x1 y0 y1]) sets the limits.
            [bodies, walls] = self.outlines();
            colours = [0.25 0.45 0.75; 0.85 0.45 0.20; 0.35 0.65 0.35; 0.60 0.40 0.70; 0.75 0.65 0.20];
            cla();
            hold('on');
            for k = 1:numel(walls)
                if k > self.obstacles
                    plot(walls{k}(1, :), walls{k}(2, :), 'k', 'linewidth', 2);
                else
                    patch(walls{k}(1, :), walls{k}(2, :), [0.7 0.7 0.7]);
                end
            end
            for k = 1:numel(bodies)
                patch(bodies{k}(1, :), bodies{k}(2, :), colours(1 + mod(self.links(k).body - 1, 5), :));
            end
            hold('off');
            axis('equal');
            if nargin > 1
                axis(limits);
            end
            title(sprintf('t = %.2f', self.time()));
            box('on');
        end

        function animate(self, times, varargin)
        %ANIMATE  animate(times) advances to each of the times and draws.
        %   animate(times, 'limits', [x0 x1 y0 y1], 'frames', 'folder') also writes folder/frame_0001.png, ...
            options = struct('limits', [], 'frames', '');
            for k = 1:2:numel(varargin)
                if k == numel(varargin) || ~ischar(varargin{k}) || ~isfield(options, varargin{k})
                    error('nekton:arg:option', 'animate has the options limits and frames');
                end
                options.(varargin{k}) = varargin{k + 1};
            end
            if ~isempty(options.frames) && exist(options.frames, 'dir') ~= 7
                mkdir(options.frames);
            end
            for k = 1:numel(times)
                self.advance(times(k));
                if isempty(options.limits)
                    self.plot();
                else
                    self.plot(options.limits);
                end
                if isempty(options.frames)
                    drawnow();
                else
                    nekton_print(gcf(), fullfile(options.frames, sprintf('frame_%04d.png', k)));
                end
            end
        end
    end

    methods (Access = private)
        function [names, rows] = parameters(self)
            % What linearize knows by name, with kind, number and component.
            names = {};
            rows = zeros(0, 3);
            % A lone swimmer keeps its impulse: forces from outside have no place in its state.
            alone = self.plan.formulation == 2;
            if self.plan.fluid
                names{end + 1} = 'fluid_density';
                rows(end + 1, :) = [1 0 0];
            end
            if ~alone
                names{end + 1} = 'gravity';
                rows(end + 1, :) = [2 0 0];
            end
            own = {'mass', 'inertia', 'force_x', 'force_y', 'torque'};
            kinds = [3 0; 4 0; 5 1; 5 2; 5 3];
            if alone
                own = own(1:2);
            end
            for i = 1:self.plan.links
                for k = 1:numel(own)
                    names{end + 1} = sprintf('link%d.%s', i, own{k}); %#ok<AGROW>
                    rows(end + 1, :) = [kinds(k, 1), i, kinds(k, 2)]; %#ok<AGROW>
                end
            end
            driven = {'torque', 'stiffness', 'damping', 'rest'};
            moved = {'position', 'rate', 'acceleration'};
            facts = nekton_mex('joints', self.id);
            for j = 1:size(facts, 1)
                words = driven;
                first = 6;
                if facts(j, 3)
                    words = moved;
                    first = 10;
                end
                for k = 1:numel(words)
                    names{end + 1} = sprintf('joint%d.%s', j, words{k}); %#ok<AGROW>
                    rows(end + 1, :) = [first + k - 1, j, 0]; %#ok<AGROW>
                end
            end
        end

        function prepare(self, next)
            % The controls of the control step that ends at next, unless they are set.
            if isempty(self.last) || self.last{3} ~= next
                self.interval(next - self.controlStep, next);
            end
        end

        function t = command(self, t)
            % The end of the control step that t is but for rounding; NaN: none.
            near = round(t / self.controlStep) * self.controlStep;
            if abs(near - t) > 8 * eps(abs(t) + self.controlStep)
                near = NaN;
            end
            t = near;
        end

        function interval(self, from, to)
            if ~isempty(self.last) && abs(self.last{3} - from) <= 8 * eps(abs(from) + self.controlStep)
                c0 = self.last{4};
                from = self.last{3};
            else
                c0 = Nekton.evaluate(self.control, from);
            end
            c1 = Nekton.evaluate(self.control, to);
            nekton_mex('channels', self.id, from, c0, to, c1);
            self.last = {from, c0, to, c1};
        end
    end

    methods (Static, Access = private)
        function c = evaluate(f, t)
            [c, dc, ddc] = f(t);
            c = [c(:), dc(:), ddc(:)];
        end

        function release(id)
            try
                nekton_mex('free', id);
            catch
                % Already gone with the file.
            end
        end

        function method = chooseMethod(options, run)
            % Option, key of the scene's run.integrator, default.
            choices = {'method', 'method', 'adams'; 'step', 'step', 0; 'tolerance', 'tolerance', 1e-9; ...
                'MaxStep', 'max_step', 0; 'InitialStep', 'first_step', 0};
            given = struct();
            if isfield(run, 'integrator')
                given = run.integrator;
            end
            chosen = choices(:, 3);
            for k = 1:numel(chosen)
                if ~isempty(options.(choices{k, 1}))
                    chosen{k} = options.(choices{k, 1});
                    % 0 stands for none inside only.
                    if k > 3 && isequal(chosen{k}, 0)
                        error('nekton:arg:range', '%s must be positive', choices{k, 1});
                    end
                elseif isfield(given, choices{k, 2})
                    chosen{k} = given.(choices{k, 2});
                end
                if k > 1 && ~(isnumeric(chosen{k}) && isscalar(chosen{k}))
                    error('nekton:arg:class', '%s must be a number', choices{k, 1});
                end
            end
            method = {chosen{1}, [chosen{2}, chosen{3}, chosen{3}, chosen{4}, chosen{5}]};
        end
    end
end
