:- module(people_start, [begin/2, finish/1]).

/** <module> A host for each person that is named at the command line

*Threading*: the main thread.
*/

:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module('../../prolog/typhon').
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

opt_type(port, port, nonneg).
opt_type(bind, bind, atom).
opt_type(advertise, advertise, atom).
opt_type(qr, qr, boolean).

opt_help(help(usage), " -- NAME ... [options]").
opt_help(port, "Port of the page for people [8081]").
opt_help(bind, "Interface of the page for people [localhost]").
opt_help(advertise, "Address of this computer, where phones find it").
opt_help(qr, "Print the links as QR codes, too [false]").

opt_meta(bind, 'ADDRESS').
opt_meta(advertise, 'ADDRESS').

%!  begin(+Argv, -Names:list(atom)) is det.
%!  finish(+Names) is det.
%
%   The hosts of Names are linked to the host `desk`.  People see what agents
%   show until someone presses Enter.

begin(Argv, Names) :-
    arguments(Argv, Names, Options),
    host_start(desk),
    people_start(Names, [link(desk)|Options]).

finish(Names) :-
    format("Press Enter to end~n"),
    read_line_to_string(user_input, _),
    forall(member(Host, [desk|Names]), host_stop(Host)),
    people_stop.
