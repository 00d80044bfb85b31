:- module(typhon_cell_hosts,
          [ walled/2                    % ?Host, -Kind
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/host', [host_option/2, time_kind/1]).
:- use_module(cells, [cells_begin/1, cells_end/1]).

/** <module> Which hosts have cells

A host with a policy runs its agents in cells.  It does not start where the
operating system cannot have them.  With cell(none), in virtual time, and with
the quota `inferences` it has none: a warning names the risk, once in a process.

*Threading*: under the mutex of host_start/2.
*/

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changes/2,
    typhon_host_parts:ends/1,
    typhon_host_parts:untrusted/1,
    typhon_on_demand:joins/2,
    typhon_options:declared/4,
    prolog:message//1.

:- dynamic
    walled/2,                   % Host, Kind: `owner` or `host`
    warned/1.                   % Why: reason for no cells, reported already

%!  walled(?Host, -Kind) is nondet.
%
%   Untrusted agents on Host run in cells: one for each owner if Kind is
%   `owner`, one for all of them if Kind is `host`.

typhon_options:declared(host_option, cell(Kind), oneof([none,owner,host]),
                        Kind).

typhon_on_demand:joins(untrusted, any).

typhon_host_parts:begins(Host, _, Options) :-
    (   is_untrusted(Options)
    ->  wall(Host, Options)
    ;   memberchk(cell(Kind), Options),
        Kind \== none
    ->  throw(error(existence_error(host_option, policy),
                    context(_, 'only hosts with policy(guarded), or a file \c
                                of rules, have cells')))
    ;   true
    ).

typhon_host_parts:changes(policy(Policy), Host) :-
    (   walled(Host, _)
    ->  true
    ;   is_untrusted([policy(Policy)])
    ->  findall(Option,
                ( member(Option, [cell(_),clock(_),quota(_)]),
                  host_option(Host, Option) ), Options),
        wall(Host, Options)
    ;   true
    ).
typhon_host_parts:changes(quota(Quotas), Host) :-
    walled(Host, _),
    (   excluded([quota(Quotas)], Error, _)
    ->  throw(Error)
    ;   true
    ).

typhon_host_parts:ends(Host) :-
    (   retract(walled(Host, _))
    ->  cells_end(Host)
    ;   true
    ).

is_untrusted(Options) :-
    member(Option, Options),
    typhon_host_parts:untrusted(Option),
    !.

wall(Host, Options) :-
    memberchk(cell(none), Options),
    !,
    warn(Host, 'it has cell(none)').
wall(Host, Options) :-
    excluded(Options, Error, Why),
    !,
    (   memberchk(cell(_), Options)
    ->  throw(Error)
    ;   warn(Host, Why)
    ).
wall(Host, Options) :-
    (   memberchk(cell(Kind), Options)
    ->  true
    ;   Kind = owner
    ),
    cells_begin(Host),
    assertz(walled(Host, Kind)).

%   excluded(+Options, -Error, -Why) is semidet.
%
%   A host with Options can have no cells.  This thread counts inferences, but a
%   cell runs the machine in another process.  Virtual time would pass while the
%   agent waits for its cell.

excluded(Options, error(permission_error(limit, cell, inferences(N)),
                        context(_, 'a turn in a cell is limited by the quota \c
                                    seconds')),
         'it has the quota inferences') :-
    memberchk(quota(Quotas), Options),
    memberchk(inferences(N), Quotas),
    !.
excluded(Options, error(permission_error(start, cell, clock(Kind)),
                        context(_, 'agents in cells live in real time')),
         'its time is virtual') :-
    (   memberchk(clock(Kind), Options)
    ;   time_kind(Kind)
    ),
    Kind \== real,
    !.

warn(Host, Why) :-
    (   warned(Why)
    ->  true
    ;   assertz(warned(Why)),
        print_message(warning, typhon(no_cells(Host, Why)))
    ).

prolog:message(typhon(no_cells(Host, Why))) -->
    [ 'Untrusted agents on ~w run in the process of the host, since ~w'-
          [Host, Why], nl,
      'The rules of the policy protect against mistakes, not against \c
       attackers'-[] ].
