function raises(id, f, varargin)
% f(varargin{:}) must raise an error with this identifier.
try
    f(varargin{:});
catch problem
    assert(strcmp(problem.identifier, id), 'error %s instead of %s: %s', problem.identifier, id, problem.message);
    return
end
error('nekton:test:silent', 'no error; expected %s', id);
end
