:- module(quick_start, []).

% Preloaded in the processes that suites start, and imported nowhere; see
% test_quick_swipl.

:- use_module('../../prolog/typhon', []).

% What most of them load besides.

:- use_module('../../prolog/typhon/network/child_output', []).
:- use_module('../../prolog/typhon/network/children', []).
:- use_module('../../prolog/typhon/options/journal', []).
:- use_module('../../prolog/typhon/options/snapshot', []).
:- use_module(quick_system, []).
:- use_module(library(settings), [load_settings/1]).

%   An engine of a fleet that answers late on a busy machine is not down. The
%   setting is that of a module that is not loaded yet; module `slowness` would
%   expand goals of all that is loaded later.

engine_has_time :-
    ( getenv('TYPHON_SLOWNESS', Atom) -> true ; Atom = '1' ),
    atom_number(Atom, Factor),
    Seconds is 2*max(1, Factor),
    setup_call_cleanup(
        tmp_file_stream(utf8, File, Out),
        format(Out, '~q.~n',
               [setting(typhon_fleet:engine_seconds, Seconds)]),
        close(Out)),
    load_settings(File),
    delete_file(File).

:- engine_has_time.

%   The processes of networks run this state, too: it has no goal of its own,
%   for which the library avoids saved states.

:- abolish(typhon_node_program:swipl/1),
   assertz((typhon_node_program:swipl(Swipl) :-
                current_prolog_flag(executable, Swipl))),
   compile_predicates([typhon_node_program:swipl/1]).
