:- module(typhon_index,
          [ part_joins/3,               % ?Seam, ?What, ?Part
            part_file/2                 % ?Part, ?File
          ]).

/** <module> What is loaded on demand

Made by `swipl doc/layers.pl -- index`, and compared by `make check`.

*Threading*: facts.
*/

%!  part_joins(?Seam, ?What, ?Part) is nondet.
%
%   Part defines the hook Seam for What.

part_joins(received,log,network).
part_joins(requested,everywhere,'options/watch').
part_joins(requested,log,network).
part_joins(requested,node,network).
part_joins(requested,watch,'options/watch').
part_joins(requested,watched,'options/watch').

%!  part_file(?Part, ?File) is nondet.
%
%   File, below prolog/typhon, defines hooks of Part.

part_file(network,'network/appointments').
part_file(network,'network/carrier').
part_file(network,'network/changes').
part_file(network,'network/children').
part_file(network,'network/dynamics').
part_file(network,'network/loading').
part_file(network,'network/log').
part_file(network,'network/networks').
part_file(network,'network/plan').
part_file(network,'network/topology').
part_file(network,'network/wiring').
part_file('options/watch','options/watch/counting').
part_file('options/watch','options/watch/everywhere').
part_file('options/watch','options/watch/listening').
part_file('options/watch','options/watch/metrics').
part_file('options/watch','options/watch/overview').
part_file('options/watch','options/watch/telling').
