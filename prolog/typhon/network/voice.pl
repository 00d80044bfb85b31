:- module(typhon_voice,
          [ voice_begin/0,
            voice_end/0,
            voice_heard/2               % +Who, +Line
          ]).
:- use_module('../base/output', [output_forward/1, output_own/0]).

/** <module> What a child process has to say to people

A child of a network has no terminal: what it prints is read by the process
that started it, and printed there. Messages go as terms, so that they are
messages there, too, shown or not as the person who sits there wishes. Lines
that agents print come with the name of their host.

*Threading*: voice_begin/0 in the main thread of a child, voice_heard/2 in the
thread that follows it.
*/

:- multifile
    prolog:message//1,
    user:message_hook/3,
    user:message_property/2.

:- dynamic
    user:message_hook/3,
    user:message_property/2.

:- dynamic
    ended/0.

%!  voice_begin is det.
%!  voice_end is det.
%
%   What this process prints from now on is meant for another; its messages
%   are of no interest any more.

voice_end :-
    assertz(ended).

voice_begin :-
    output_forward(typhon_voice:said),
    output_own,
    asserta((user:message_hook(_, Kind, Lines) :-
                typhon_voice:message(Kind, Lines))).

:- public
    message/2,                  % called by the hook
    said/2.                     % called with lines of agents

said(none, Line) :-
    !,
    format(user_output, '~s~n', [Line]).
said(Mark, Line) :-
    format(user_output, '[~w] ~s~n', [Mark, Line]).

%   message(+Kind, +Lines) is semidet: fails for what is not told.

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
    format(user_output, '\u0001~q~n', [message(Kind, Text)]).

placed(Kind, Lines, ['~w:~d: '-[File, Line]|Lines]) :-
    memberchk(Kind, [error, warning]),
    source_location(File, Line),
    !.
placed(_, Lines, Lines).

%!  voice_heard(+Who, +Line) is det.
%
%   The child Who, a term Network-P, has printed Line.

voice_heard(Who, Line) :-
    string_concat("\u0001", Said, Line),
    catch(term_string(message(Kind, Text), Said),
          error(_, _), fail),
    ground(Kind),
    string(Text),
    !,
    setup_call_cleanup(
        nb_setval(typhon_voice, Who),
        print_message(Kind, typhon(voice(Text))),
        nb_delete(typhon_voice)).
voice_heard(_, Line) :-
    format('~s~n', [Line]).

%   What agents tell says who and where; what rooms complain of does not.

user:message_property(Kind, prefix(Prefix)) :-
    nb_current(typhon_voice, Network-P),
    typhon_voice:begins(Kind, Begin),
    format(string(Prefix), '~~N~w[~w/~w] ', [Begin, Network, P]).

:- public
    begins/2.

begins(error, 'ERROR: ').
begins(warning, 'Warning: ').
begins(debug(_), '% ').

prolog:message(typhon(voice(Text))) -->
    { split_string(Text, "\n", "", Lines) },
    text(Lines).

text([Line]) -->
    !,
    [ '~s'-[Line] ].
text([Line|Lines]) -->
    [ '~s'-[Line], nl ],
    text(Lines).
