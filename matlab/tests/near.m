function near(actual, expected, tolerance)
% |actual - expected| <= tolerance, entry by entry.
difference = max(abs(actual(:) - expected(:)));
assert(numel(actual) == numel(expected) && difference <= tolerance, 'differs by %g, more than %g', difference, tolerance);
end
