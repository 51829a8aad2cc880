function nekton_print(fig, name)
%NEKTON_PRINT  nekton_print(fig, 'name.png') writes a figure as PNG of 576 x 432 points, whatever is on the screen.
set(fig, 'paperpositionmode', 'manual', 'paperunits', 'inches', 'paperposition', [0 0 8 6]);
print(fig, name, '-dpng', '-r72');
end
