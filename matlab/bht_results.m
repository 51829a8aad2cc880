function results = bht_results(name)
%BHT_RESULTS  Results for the DAT-file name (or of the MAT-file name), as bht_traject_compute wrote them.
[~, base] = fileparts(regexprep(name, '\.dat$', ''));
for file = {bht_mat([base '_results']), bht_mat(name)}
    if exist(file{1}, 'file') == 2
        results = load(file{1});
        if isfield(results, 'gene_data')
            return
        end
    end
end
error('nekton:bht:file', 'there is no %s: run bht_traject_compute first', bht_mat([base '_results']));
end
