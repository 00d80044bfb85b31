:- module(typhon_child_output,
          [ output_begin/0,
            output_end/0,
            output_line/2               % +Child, +Line
          ]).

/** <module> Output of the child processes of a network

A child of a network has no terminal: the process that started it reads its
standard output and prints it. Messages are sent as terms, so that the parent
prints them as messages, or not, according to its own verbosity. Other lines
are printed with the name of the network and the number of the process.

*Threading*: output_begin/0 in the main thread of a child, output_line/2 in the
thread that follows it.
*/

:- use_module('../kernel/base/text', [format_shown/3]).

:- multifile
    prolog:message//1,
    user:message_hook/3,
    user:message_property/2.

:- dynamic
    user:message_hook/3,
    user:message_property/2.

:- dynamic
    ended/0.

%!  output_begin is det.
%!  output_end is det.
%
%   Between these calls messages of this process are sent to its parent; after
%   output_end/0 they are dropped.

output_end :-
    assertz(ended).

output_begin :-
    asserta((user:message_hook(_, Kind, Lines) :-
                typhon_child_output:message(Kind, Lines))).

:- public
    message/2.                  % called by the hook

%   message(+Kind, +Lines) is semidet: fails for messages that are not sent.
%   An agent may have begun a line: the message begins a new one.

message(_, _) :-
    ended,
    !.
message(Kind, Lines0) :-
    \+ memberchk(Kind, [silent, banner, query]),
    Lines0 \== [],
    placed(Kind, Lines0, Lines),
    with_output_to(string(Text0),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text0, "", "\n", [Text]),
    format(user_output, '~N\u0001~q~n', [message(Kind, Text)]).

placed(Kind, Lines, ['~w:~d: '-[File, Line]|Lines]) :-
    memberchk(Kind, [error, warning]),
    source_location(File, Line),
    !.
placed(_, Lines, Lines).

%!  output_line(+Child, +Line) is det.
%
%   Print Line, which the child Network-P has printed.

output_line(Child, Line) :-
    string_concat("\u0001", Said, Line),
    catch(term_string(message(Kind, Text), Said),
          error(_, _), fail),
    ground(Kind),
    string(Text),
    !,
    setup_call_cleanup(
        nb_setval(typhon_child_output, Child),
        print_message(Kind, typhon(child_output(Text))),
        nb_delete(typhon_child_output)).
output_line(Network-P, Line) :-
    format_shown(user_output, '[~w/~w] ~w~n', [Network, P, Line]).

%   Errors, warnings and debug messages do not name their process.

user:message_property(Kind, prefix(Prefix)) :-
    nb_current(typhon_child_output, Network-P),
    typhon_child_output:begins(Kind, Begin),
    format(string(Prefix), '~~N~w[~w/~w] ', [Begin, Network, P]).

:- public
    begins/2.

begins(error, 'ERROR: ').
begins(warning, 'Warning: ').
begins(debug(_), '% ').

prolog:message(typhon(child_output(Text))) -->
    { split_string(Text, "\n", "", Lines) },
    text(Lines).

text([Line]) -->
    !,
    [ '~s'-[Line] ].
text([Line|Lines]) -->
    [ '~s'-[Line], nl ],
    text(Lines).
