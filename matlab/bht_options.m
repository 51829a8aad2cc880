function options = bht_options(options, varargin)
%BHT_OPTIONS  Pairs of name and value into a struct with defaults; a lone first argument is the DataFilename.
if mod(numel(varargin), 2) == 1
    varargin = [{'DataFilename'}, varargin];
end
for k = 1:2:numel(varargin)
    if ~ischar(varargin{k}) || ~isfield(options, varargin{k})
        names = fieldnames(options)';
        error('nekton:bht:option', 'the options are: %s', strtrim(sprintf('%s ', names{:})));
    end
    options.(varargin{k}) = varargin{k + 1};
end
end
