:- module(typhon_seals,
          [ seal/3,                     % +Term, +For, -Sealed
            unseal/2                    % +Sealed, -Term
          ]).

/** <module> Terms encrypted for one host

An agent seals a term for a host, usually its home; on its way there no other
process can read the term, or change it undetected.  The key is that of the
process of the host, see doc/keys.md.  A process that can read an agent can also
read the terms that the agent seals there.

*Threading*: the thread that runs the agent; seal/3 may wait for an answer if
the host is in another process.
*/

:- use_module(library(error), [existence_error/2, must_be/2]).
:- autoload('../keys',
              [ keys_certificate/2, keys_holder/3, keys_seal/4,
                keys_unseal/3, own_keys/1 ]).
:- use_module('../../kernel/base/text', [term_text/2, text_term/2]).
:- use_module('../../kernel/program', [vocabulary/1]).
:- use_module('../../kernel/wire', [endpoint_reply/2, mobile_term/1]).
:- use_module('../../kernel/host', [host_resolve/2, process_ask/6]).

:- vocabulary(typhon_seals).

:- multifile typhon_endpoint:requested/4.

answer_seconds(10).

%!  seal(+Term, +For, -Sealed) is det.
%!  unseal(+Sealed, -Term) is det.
%
%   Sealed is Term, encrypted for the host For, an address or a name; Term is
%   the term that was sealed for the host on which this agent is.
%
%   @error existence_error(keys, Host): Host, or this process, has no keys
%   @error type_error(mobile_term, Culprit)
%   @error host_unreachable(For)
%   @error permission_error(unseal, term, Sealed): Sealed is for another host,
%   or has been changed

seal(Term, For, Sealed) :-
    must_be(atom, For),
    mobile_term(Term),
    keys_here(Keys),
    host_resolve(For, Where),
    certificate(Where, Keys, Certificate),
    (   keys_holder(Keys, Certificate, host(_))
    ->  true
    ;   existence_error(keys, For)
    ),
    term_text(Term, Text),
    keys_seal(Keys, Text, Certificate, Sealed).

unseal(Sealed, Term) :-
    keys_here(Keys),
    keys_unseal(Keys, Sealed, Text),
    text_term(Text, Term).

keys_here(Keys) :-
    (   own_keys(Keys0)
    ->  Keys = Keys0
    ;   existence_error(keys, here)
    ).

certificate(local(_), Keys, Certificate) :-
    keys_certificate(Keys, Certificate).
certificate(remote(Address, _, Endpoint), _, Certificate) :-
    answer_seconds(Seconds),
    process_ask(Endpoint, Address, certificate, of_yours, Answer, Seconds),
    (   Answer = certificate(Certificate)
    ->  true
    ;   existence_error(keys, Address)
    ).

typhon_endpoint:requested(certificate, of_yours, _, ReplyTo) :-
    (   own_keys(Keys)
    ->  keys_certificate(Keys, Certificate),
        Answer = certificate(Certificate)
    ;   Answer = none
    ),
    endpoint_reply(ReplyTo, Answer).
