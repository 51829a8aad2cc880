function name = bht_mat(name)
%BHT_MAT  Name of a MAT-file with its extension.
if isempty(regexp(name, '\.mat$', 'once'))
    name = [name '.mat'];
end
end
