%   Dynamic networks over the grid: section 5.5.
%
%   Expects ground.pl, and `links`: dynamic_1, dynamic_2.

fixed(topology, grid, printed("section 5.5")).
fixed(delta, 0.2, printed("section 5.6.5")).
fixed(interval, 5-10, tuned("each host, so many seconds between its changes; \c
with 10-20, of section 4.4.7, some hosts are cut off for a whole task")).
fixed(drop_1, 0.2, tuned("Dynamic I prints no probabilities; with 0.5 hosts \c
are cut off for long")).
fixed(make_1, 0.9, tuned("as drop_1")).
fixed(drop_2, 0.5, printed("section 5.5")).
fixed(make_2, 0.7, printed("section 5.5")).

%   Dynamic I: links of the grid, and no others, break and are made again.
%   Dynamic II: a host drops one of its links, and makes one to any host.

model(Case, toggle(uniform(Min, Max), Case.drop_1, Case.make_1)) :-
    Case.links == dynamic_1,
    Min-Max = Case.interval.
model(Case, links(uniform(Min, Max), Case.drop_2, Case.make_2)) :-
    Case.links == dynamic_2,
    Min-Max = Case.interval.

label(dynamic_1, "Dynamic I").
label(dynamic_2, "Dynamic II").
