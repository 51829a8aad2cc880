function scene = nekton_scene_file(name)
%NEKTON_SCENE_FILE  Read a scene file into a struct as nekton_scene takes it.
%   scene = NEKTON_SCENE_FILE('fish.json') reads JSON with the keys of docs/scene-file.md.
%   scene = NEKTON_SCENE_FILE('fish.toml') lets Python (3.11 or later, command python3) turn TOML into JSON first.
%
%   Tables and outlines in separate files are not supported.

if exist(name, 'file') ~= 2
    error('nekton:scene:file', 'there is no file %s', name);
end
[~, ~, extension] = fileparts(name);
switch lower(extension)
    case '.json'
        text = fileread(name);
    case '.toml'
        code = 'import sys,json,tomllib; print(json.dumps(tomllib.load(sys.stdin.buffer)))';
        [status, text] = system(sprintf('python3 -c "%s" < "%s" 2>&1', code, name));
        if status ~= 0
            error('nekton:scene:toml', ['%s could not be turned into JSON by Python 3.11 or later; ' ...
                'please convert it and give the .json file:\n%s'], name, text);
        end
    otherwise
        error('nekton:scene:file', '%s: a scene file is .json or .toml', name);
end
scene = jsondecode(text);
end
