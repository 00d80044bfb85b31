:- module(typhon_process_setup,
          [ process_setup/0,
            descriptors_open/0,
            on_stop_signals/1           % :Handler
          ]).
:- use_module(library(lists), [member/2]).

/** <module> What a process of Typhon sets up first

Services, containers and scripts start processes with closed standard streams,
the locale C, and signals that a terminal does not send.

*Threading*: the main thread, before others exist; descriptors_open/0 any thread.
*/

:- meta_predicate on_stop_signals(1).

%!  process_setup is det.
%
%   As descriptors_open/0, and text of the environment, of file names and of
%   the standard streams may have any character.

process_setup :-
    descriptors_open,
    setlocale(ctype, Locale, Locale),
    (   memberchk(Locale, ['C', 'POSIX'])
    ->  catch(setlocale(ctype, _, 'C.UTF-8'), error(_, _), true)
    ;   true
    ).

%!  descriptors_open is det.
%
%   The descriptors 0 to 2 are open, so that no file or socket gets one of them,
%   and with it what the process prints.

descriptors_open :-
    current_prolog_flag(windows, true),
    !.
descriptors_open :-
    ( null(read, 0) ; null(append, 2) ),
    !,
    descriptors_open.
descriptors_open.

%   A new descriptor is the lowest that is free.  The alias keeps the stream from
%   being collected.

null(Mode, Most) :-
    catch(open('/dev/null', Mode, Stream), error(_, _), fail),
    stream_property(Stream, file_no(Descriptor)),
    (   Descriptor =< Most
    ->  atom_concat(typhon_descriptor_, Descriptor, Alias),
        set_stream(Stream, alias(Alias))
    ;   close(Stream),
        fail
    ).

%!  on_stop_signals(:Handler) is det.
%
%   Call Handler with the signal for each signal that asks the process to stop.

on_stop_signals(Handler) :-
    forall(member(Signal, [term, int, hup]), on_signal(Signal, _, Handler)).
