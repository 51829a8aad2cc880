function build_nekton()
%BUILD_NEKTON  Build the gateway nekton_mex, in Matlab or in Octave.
%   build_nekton builds nekton_mex in the folder of this file, after cargo (https://rustup.rs) has brought the library up to date.
%   Without cargo it takes the library that target/release has.
%
%   Nothing is to be installed besides a C compiler and, for the library, Rust. The result contains the library.

here = fileparts(mfilename('fullpath'));
root = fileparts(here);
archive = fullfile(root, 'target', 'release', 'libnekton_ffi.a');
if ispc()
    archive = fullfile(root, 'target', 'release', 'nekton_ffi.lib');
end
[missing, ~] = system('cargo --version');
if missing && exist(archive, 'file') ~= 2
    error('nekton:build:cargo', 'there is no cargo to build the library; it is part of Rust, see https://rustup.rs');
elseif missing
    warning('nekton:build:cargo', 'there is no cargo to bring the library up to date: %s is taken as it is', archive);
else
    command = sprintf('cargo build --release --package nekton-ffi --manifest-path "%s"', fullfile(root, 'Cargo.toml'));
    disp(command);
    if system(command) ~= 0
        error('nekton:build:cargo', 'cargo failed; what it says stands above');
    end
end

names = {'nekton_mex', 'arguments', 'errors', 'models', 'objects', 'outputs', 'quantities', 'scene', 'steps'};
sources = cellfun(@(name) fullfile(here, 'mex', [name '.c']), names, 'UniformOutput', false);
include = ['-I' fullfile(root, 'include')];
map = fullfile(here, 'nekton.map');
clear nekton_mex
if exist('OCTAVE_VERSION', 'builtin')
    options = {};
    if isunix() && ~ismac()
        % Only mexFunction is to be seen from outside: the library's symbols must not meet those of other files.
        options = {['-Wl,--version-script=' map], '-Wl,--gc-sections', '-s', '-lpthread', '-ldl', '-lm'};
    end
    target = fullfile(here, ['nekton_mex.' mexext()]);
    % mkoctfile leaves its objects in the present folder.
    work = tempname();
    mkdir(work);
    back = pwd();
    cd(work);
    [output, status] = mkoctfile('--mex', include, '-Wall', '-o', target, sources{:}, archive, options{:});
    cd(back);
    confirm_recursive_rmdir(false, 'local');
    rmdir(work, 's');
    if status ~= 0
        error('nekton:build:mkoctfile', 'mkoctfile failed (package octave-dev):\n%s', output);
    end
elseif isunix() && ~ismac()
    mex(include, '-outdir', here, '-output', 'nekton_mex', ['LDFLAGS=$LDFLAGS -Wl,--version-script=' map], sources{:}, archive, '-lpthread', '-ldl', '-lm');
elseif ismac()
    mex(include, '-outdir', here, '-output', 'nekton_mex', sources{:}, archive);
else
    mex(include, '-outdir', here, '-output', 'nekton_mex', sources{:}, archive, '-lws2_32', '-luserenv', '-lntdll', '-lbcrypt', '-ladvapi32');
end
fprintf('built nekton_mex in %s\n', here);
end
